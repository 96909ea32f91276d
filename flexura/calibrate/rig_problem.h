#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_rows.h"
#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// Indices of an observation that the rig does not explain.
struct RigOutlier {
  std::size_t image = 0;
  /// Index in the list of the image's markers, then its axis points, then its etalon points.
  std::size_t thing = 0;

  bool operator==(const RigOutlier&) const = default;
};

/// The cost function of a rig estimate. The cost is half the sum of the costs of all observation residuals
/// and of the squared deviations of x from the prior, both in standard deviations. A residual's cost is its
/// square up to a bound, and linear beyond (P. J. Huber, 1964).
class RigProblem {
 public:
  RigProblem(const RigModel& guess, const RigPrior& prior, RigObservations seen);

  [[nodiscard]] const RigVariables& variables() const { return variables_; }
  [[nodiscard]] const RigPrior& prior() const { return prior_; }
  [[nodiscard]] const RigObservations& observations() const { return seen_; }

  /// Assigns a rim half (RimHalf) to each point of the cylinder's rims: the half that bounds the silhouette
  /// for the rig at x. Later functions use these halves. Returns whether any half changed.
  bool choose_rims(const Eigen::VectorXd& x);
  /// Linearises the residuals at x. Returns false if an observed point would be invisible for the rig at x.
  [[nodiscard]] bool linearise(const Eigen::VectorXd& x);
  [[nodiscard]] const std::vector<RigRows>& rows() const { return rows_; }

  /// Returns the cost at the linearisation point. `bound`: size of a residual, in standard deviations, beyond
  /// which its cost is linear.
  [[nodiscard]] double cost(double bound) const;
  /// Computes the gradient and the Gauss-Newton matrix. Only the lower triangle of the matrix is set.
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
