#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_rows.h"
#include "flexura/calibrate/rig_variables.h"

namespace flexura {

/// A thing that was seen, and that the rig does not explain.
struct RigDoubt {
  std::size_t image = 0;
  std::size_t thing = 0;  ///< Of the image's markers, then of its axis points, then of its etalon's points.

  bool operator==(const RigDoubt&) const = default;
};

/// What is least at the rig that explains the observations best: half the sum of what the things seen are off
/// (in units of their standard deviations, squared up to a bound and linear beyond: P. J. Huber, 1964), and
/// of what x is off the prior.
class RigProblem {
 public:
  RigProblem(const RigModel& guess, const RigPrior& prior, RigObservations seen);

  [[nodiscard]] const RigVariables& variables() const { return variables_; }
  [[nodiscard]] const RigPrior& prior() const { return prior_; }
  [[nodiscard]] const RigObservations& observations() const { return seen_; }

  /// From now on points of the cylinder's rims are held against the halves of these that the cameras of the
  /// rig at x see (RimHalf), wherever a camera stands then. Whether this changed anything.
  bool choose_rims(const Eigen::VectorXd& x);
  /// Linearised at x. False where the rig would not show what was seen.
  [[nodiscard]] bool linearise(const Eigen::VectorXd& x);
  [[nodiscard]] const std::vector<RigRows>& rows() const { return rows_; }

  /// Of x as linearised, with this bound on residuals.
  [[nodiscard]] double cost(double bound) const;
  /// Its gradient and Gauss-Newton matrix, of which only the lower triangle is set.
  void normal(double bound, Eigen::VectorXd& gradient, Eigen::MatrixXd& matrix) const;

  /// Sizes of what was seen's residuals, doubted things left out.
  [[nodiscard]] std::vector<double> sizes() const;
  /// Root of the mean square of the residuals' entries, doubted things left out; and how many these are.
  [[nodiscard]] double rms() const;
  [[nodiscard]] std::size_t entries() const;

  /// Takes everything whose residual is larger than `bound` for something else's, and the rest for the arm's.
  /// Whether this changed anything.
  bool doubt_beyond(double bound);
  void doubt_nothing();
  [[nodiscard]] std::vector<RigDoubt> doubts() const;

 private:
  template <class Visit>
  void for_each_thing(const Visit& visit) const;

  RigPrior prior_;
  RigVariables variables_;
  RigObservations seen_;
  Eigen::VectorXd x_;
  std::vector<RigRows> rows_;
  std::vector<std::vector<bool>> is_doubted_;
};

}  // namespace flexura
