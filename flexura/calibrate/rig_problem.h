#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_rows.h"
#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// An observation that the rig does not explain, by its indices.
struct RigOutlier {
  std::size_t image = 0;
  std::size_t thing = 0;  ///< Index in the image's markers, then axis points, then etalon points.

  bool operator==(const RigOutlier&) const = default;
};

/// The cost function of a rig estimate. The cost is half the sum over the observation residuals and the
/// deviations of x from the prior, in standard deviations. A residual's cost is its square up to a bound, and
/// linear beyond (P. J. Huber, 1964).
class RigProblem {
 public:
  RigProblem(const RigModel& guess, const RigPrior& prior, RigObservations seen);

  [[nodiscard]] const RigVariables& variables() const { return variables_; }
  [[nodiscard]] const RigPrior& prior() const { return prior_; }
  [[nodiscard]] const RigObservations& observations() const { return seen_; }

  /// Assigns a rim half (RimHalf) to each point of the cylinder's rims: the half that the rig's cameras at x
  /// see. The halves then stay fixed. Returns whether any half changed.
  bool choose_rims(const Eigen::VectorXd& x);
  /// Linearises at x. Returns false if the rig at x would not show the observations.
  [[nodiscard]] bool linearise(const Eigen::VectorXd& x);
  [[nodiscard]] const std::vector<RigRows>& rows() const { return rows_; }

  /// Returns the cost at the linearisation point, with the given bound of quadratic residuals.
  [[nodiscard]] double cost(double bound) const;
  /// Computes the gradient and the Gauss-Newton matrix, of which only the lower triangle is set.
  void normal(double bound, Eigen::VectorXd& gradient, Eigen::MatrixXd& matrix) const;

  /// Returns the size of the residual of each observation that is not an outlier, in standard deviations.
  [[nodiscard]] std::vector<double> sizes() const;
  /// Returns the root mean square of all residual entries except those of outliers.
  [[nodiscard]] double rms() const;
  /// Returns the number of residual entries except those of outliers.
  [[nodiscard]] std::size_t entries() const;

  /// Marks the observations whose residual is larger than `bound` as outliers, and all others as inliers.
  /// Returns whether any mark changed.
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
