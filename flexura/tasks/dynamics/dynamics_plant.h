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

/// Largest elevation, rad: nearer to a quarter turn, rounding dominates the azimuth.
inline constexpr double most_elevation = 1.569;

/// The two direction angles along an arm, theta (azimuth) and q (elevation) as in docs/estimation.md, rad.
/// theta is continuous from the base, where it is in (-pi, pi].
class AnglesAlongArm {
 public:
  /// `state` must fit the arm and be finite.
  AnglesAlongArm(const Arm& arm, const ArmState& state);

  /// Returns (theta, q) at a share in [0, 1] of a section.
  [[nodiscard]] Eigen::Vector2d at(std::size_t section, double share) const;
  /// Returns the largest |q| on the arm, sampled in small steps.
  [[nodiscard]] double largest_elevation() const { return largest_elevation_; }

 private:
  Backbone backbone_;
  std::vector<std::vector<double>> azimuths_;  // At equal shares of each section, with both ends.
  double largest_elevation_ = 0;
};

/// Converts an experiment's arm to the distributed arm of a task of kind "dynamics", and back. The base is
/// clamped.
class DynamicsPlant {
 public:
  /// For an arm in the state `from` with |q| below a quarter turn at its base. Lengths that are not variable
  /// stay as in `from`. The task must have been checked with the arm.
  DynamicsPlant(const DynamicsTask& task, const Arm& arm, const ArmState& from);

  [[nodiscard]] const DistributedArm& distributed() const { return distributed_; }
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  [[nodiscard]] const Eigen::VectorXd& target() const { return target_; }
  /// Returns true if |q| is below a quarter turn all along the arm at the start.
  [[nodiscard]] bool is_regular() const { return is_regular_; }
  /// Return the difference between the basis's angles and those of the start and target shapes, root mean
  /// square along the arm, rad.
  [[nodiscard]] double start_off() const { return start_off_; }
  [[nodiscard]] double target_off() const { return target_off_; }
  /// Returns the largest |q| of the target in the basis, rad: a polynomial may exceed its values.
  [[nodiscard]] double largest_target_elevation() const;
  /// Returns p_WB, m: the origin of the distributed arm's positions, along W's axes.
  [[nodiscard]] const Eigen::Vector3d& base() const { return arm_.X_WB.position; }

  /// Returns the state of the experiment's arm with the same directions at the sections' ends. Of arcs that
  /// differ by whole turns, takes those nearest to `before`. In a plane, with an angle that is linear in each
  /// section, this is the same curve.
  [[nodiscard]] ArmState state(const Eigen::VectorXd& x, const ArmState& before) const;
  /// Returns (theta, q) at the sections' ends, rad.
  [[nodiscard]] Eigen::Matrix2Xd end_angles(const Eigen::VectorXd& x) const;

 private:
  using Angles = std::function<Eigen::Vector2d(double s)>;
  [[nodiscard]] Eigen::VectorXd coordinates(const ArmState& state, double& off_by) const;
  [[nodiscard]] double off(const Eigen::VectorXd& x, const Angles& angles) const;

  Arm arm_;
  std::vector<double> stretches_;  // If not variable.
  DistributedArm distributed_;
  Eigen::MatrixXd ends_;  // Shape functions at the sections' ends, the clamp's last.
  Eigen::VectorXd start_, target_;
  double start_off_ = 0, target_off_ = 0;
  bool is_regular_ = true;
};

}  // namespace flexura
