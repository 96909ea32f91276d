#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "flexura/control/distributed_arm.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"
#include "flexura/tasks/dynamics/dynamics_task_config.h"

namespace flexura {

/// Largest allowed elevation, rad. At larger elevations, rounding errors dominate the azimuth, which is
/// undefined at pi/2.
inline constexpr double most_elevation = 1.569;

/// The two direction angles along an arm, rad: theta (azimuth) and q (elevation), as defined in
/// docs/estimation.md. Theta is continuous along the arm and in (-pi, pi] at the base.
class AnglesAlongArm {
 public:
  /// `state` must fit the arm and be finite.
  AnglesAlongArm(const Arm& arm, const ArmState& state);

  /// Returns (theta, q), rad, at the fraction `share` in [0, 1] of a section's length.
  [[nodiscard]] Eigen::Vector2d at(std::size_t section, double share) const;
  /// Returns the largest |q| on the arm, sampled in small steps.
  [[nodiscard]] double largest_elevation() const { return largest_elevation_; }

 private:
  Backbone backbone_;
  std::vector<std::vector<double>>
      azimuths_;  // At evenly spaced points of each section, including both ends, rad.
  double largest_elevation_ = 0;
};

/// Converts an experiment's arm to the distributed arm of a task of kind "dynamics", and back. The
/// distributed arm's base is clamped.
class DynamicsPlant {
 public:
  /// `from`: initial state of the arm, with |q| below pi/2 at the base. Lengths that are not variable remain
  /// as in `from`. The task must have been checked for this arm.
  DynamicsPlant(const DynamicsTask& task, const Arm& arm, const ArmState& from);

  [[nodiscard]] const DistributedArm& distributed() const { return distributed_; }
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  [[nodiscard]] const Eigen::VectorXd& target() const { return target_; }
  /// Returns true if |q| is below pi/2 everywhere on the arm at the start.
  [[nodiscard]] bool is_regular() const { return is_regular_; }
  /// Returns how closely the basis represents the start shape: the root mean square error of the angles along
  /// the arm, rad.
  [[nodiscard]] double start_off() const { return start_off_; }
  /// Returns how closely the basis represents the target shape: the root mean square error of the angles
  /// along the arm, rad.
  [[nodiscard]] double target_off() const { return target_off_; }
  /// Returns the largest |q| of the target in the basis, rad. A polynomial may exceed its values at the
  /// nodes.
  [[nodiscard]] double largest_target_elevation() const;
  /// Returns p_WB, m: the origin of the distributed arm's positions. These positions are in the axes of W.
  [[nodiscard]] const Eigen::Vector3d& base() const { return arm_.X_WB.position; }

  /// Returns the state of the experiment's arm with the directions of the distributed arm at the sections'
  /// ends. Several arcs that differ by full turns have these directions; the result has the arcs nearest to
  /// `before`. Both arms have the same curve if the arm is planar and its angle is linear in each section.
  [[nodiscard]] ArmState state(const Eigen::VectorXd& x, const ArmState& before) const;
  /// Returns (theta, q) at the sections' ends, rad.
  [[nodiscard]] Eigen::Matrix2Xd end_angles(const Eigen::VectorXd& x) const;

 private:
  using Angles = std::function<Eigen::Vector2d(double s)>;
  [[nodiscard]] Eigen::VectorXd coordinates(const ArmState& state, double& off_by) const;
  [[nodiscard]] double off(const Eigen::VectorXd& x, const Angles& angles) const;

  Arm arm_;
  std::vector<double> stretches_;  // Stretches of sections whose lengths are not variable.
  DistributedArm distributed_;
  Eigen::MatrixXd ends_;  // Shape functions at the sections' ends, the clamp's last.
  Eigen::VectorXd start_, target_;
  double start_off_ = 0, target_off_ = 0;
  bool is_regular_ = true;
};

}  // namespace flexura
