#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>

#include "flexura/control/distributed_arm.h"

namespace flexura {

/// A distributed arm before two parallel views, and how far it is from a target by what they show
/// (docs/control.md, eq. 14 and 15). Where the planes do not tell, or contradict each other (planes_tell,
/// planes_contradict), both pictures are triangulated: theta and q are read themselves, with the same noise.
class PlaneSight {
 public:
  /// For arms like `arm` and the coordinates `target` of one. `noise`: standard deviations of alpha_1 and
  /// alpha_2 at each of the points arm.shapes().s, rad.
  PlaneSight(const DistributedArm& arm, const Eigen::VectorXd& target, const std::array<double, 2>& noise);

  /// Looks at an arm in the state x, to which it is set. `deviate(i)` is noise of variance 1, of alpha_1 at
  /// the points first, then of alpha_2.
  void look(const DistributedArm& arm, const Eigen::VectorXd& x,
            const std::function<double(std::uint64_t i)>& deviate);

  /// Of the last look: the errors of theta and q at the points, measured less desired, rad.
  [[nodiscard]] const Eigen::VectorXd& e_theta() const { return e_theta_; }
  [[nodiscard]] const Eigen::VectorXd& e_q() const { return e_q_; }
  /// Of the last look: the coordinates whose angles are nearest to those that were read, by least squares
  /// along the arm; lengths as they are.
  [[nodiscard]] const Eigen::VectorXd& coordinates() const { return coordinates_; }
  /// Of all looks and points, the share where both pictures had to be triangulated.
  [[nodiscard]] double triangulated() const;

 private:
  std::array<double, 2> noise_;
  Eigen::VectorXd theta_d_, q_d_;              // Of the target, at the points.
  Eigen::VectorXd clamped_theta_, clamped_q_;  // What the clamped base makes of the angles there.
  Eigen::MatrixXd fit_;                        // Numbers of an angle by its values there.
  Eigen::VectorXd theta_, q_, e_theta_, e_q_, coordinates_;
  double told_ = 0, not_told_ = 0;  // Points of all looks.
};

}  // namespace flexura
