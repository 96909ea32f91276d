#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_rows.h"
#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// An outlier: an observation that the rig does not explain.
struct RigOutlier {
  std::size_t image = 0;
  std::size_t thing = 0;  ///< Index in the image's markers, then axis points, then etalon points.

  bool operator==(const RigOutlier&) const = default;
};

/// The cost function of a rig: half the sum of the observation residuals and the deviations of x from the
/// prior. Residuals are in standard deviations, squared up to a bound and linear beyond (P. J. Huber, 1964).
class RigProblem {
 public:
  RigProblem(const RigModel& guess, const RigPrior& prior, RigObservations seen);

  [[nodiscard]] const RigVariables& variables() const { return variables_; }
  [[nodiscard]] const RigPrior& prior() const { return prior_; }
  [[nodiscard]] const RigObservations& observations() const { return seen_; }

  /// Assigns to points of the cylinder's rims the rim halves that the cameras of the rig at x see (RimHalf).
  /// They then stay fixed. Returns whether this changed anything.
  bool choose_rims(const Eigen::VectorXd& x);
  /// Linearises at x. Returns false if the rig would not show what was seen.
  [[nodiscard]] bool linearise(const Eigen::VectorXd& x);
  [[nodiscard]] const std::vector<RigRows>& rows() const { return rows_; }

  /// Returns the cost at the linearisation point, with this bound on residuals.
  [[nodiscard]] double cost(double bound) const;
  /// Computes the gradient and the Gauss-Newton matrix, of which only the lower triangle is set.
  void normal(double bound, Eigen::VectorXd& gradient, Eigen::MatrixXd& matrix) const;

  /// Returns the sizes of the residuals, without outliers.
  [[nodiscard]] std::vector<double> sizes() const;
  /// Return the root mean square of the residual entries and their number, without outliers.
  [[nodiscard]] double rms() const;
  [[nodiscard]] std::size_t entries() const;

  /// Marks exactly the observations whose residual is larger than `bound` as outliers. Returns whether this
  /// changed anything.
  bool exclude_beyond(double bound);
  void include_all();
  [[nodiscard]] std::vector<RigOutlier> outliers() const;

 private:
  template <class Visit>
  void for_each_thing(const Visit& visit) const;

  RigPrior prior_;
  RigVariables variables_;
  RigObservations seen_;
  Eigen::VectorXd x_;
  std::vector<RigRows> rows_;
  std::vector<std::vector<bool>> is_outlier_;
};

}  // namespace flexura
