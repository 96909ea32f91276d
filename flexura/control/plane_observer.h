#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>

#include "flexura/control/distributed_arm.h"

namespace flexura {

/// A distributed arm in two parallel views, and its errors from a target by these views (docs/control.md, eq.
/// 14 and 15). Where the planes do not determine the way, or contradict each other (planes_determine,
/// planes_contradict), both pictures are triangulated. Then theta and q are measured directly, with the same
/// noise.
class PlaneObserver {
 public:
  /// For arms like `arm` and the coordinates `target` of one. `noise`: standard deviations of alpha_1 and
  /// alpha_2 at each of the points arm.shapes().s, rad.
  PlaneObserver(const DistributedArm& arm, const Eigen::VectorXd& target, const std::array<double, 2>& noise);

  /// Measures an arm, which is set to the state x. `deviate(i)` returns noise of variance 1, for alpha_1 at
  /// the points first, then for alpha_2.
  void look(const DistributedArm& arm, const Eigen::VectorXd& x,
            const std::function<double(std::uint64_t i)>& deviate);

  /// Return the errors of theta and q at the points in the last measurement, measured minus desired, rad.
  [[nodiscard]] const Eigen::VectorXd& e_theta() const { return e_theta_; }
  [[nodiscard]] const Eigen::VectorXd& e_q() const { return e_q_; }
  /// Returns the coordinates with the angles nearest to the measured ones, by least squares along the arm,
  /// for the last measurement; lengths are the true ones.
  [[nodiscard]] const Eigen::VectorXd& coordinates() const { return coordinates_; }
  /// Returns the share of triangulated points over all measurements.
  [[nodiscard]] double triangulated() const;

 private:
  std::array<double, 2> noise_;
  Eigen::VectorXd theta_d_, q_d_;              // Of the target, at the points.
  Eigen::VectorXd clamped_theta_, clamped_q_;  // Contribution of the clamped base to the angles there.
  Eigen::MatrixXd fit_;                        // Maps an angle's values there to its numbers.
  Eigen::VectorXd theta_, q_, e_theta_, e_q_, coordinates_;
  double determined_ = 0, undetermined_ = 0;  // Points of all measurements.
};

}  // namespace flexura
