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

/// Nearer to a quarter turn an azimuth is known to rounding only, rad.
inline constexpr double most_elevation = 1.569;

/// The two angles of an arm's direction along it, theta (azimuth) and q (elevation) as in docs/estimation.md,
/// rad: theta goes on continuously from the base, where it is in (-pi, pi].
class AnglesAlongArm {
 public:
  /// `state` fits the arm and is finite.
  AnglesAlongArm(const Arm& arm, const ArmState& state);

  /// (theta, q) at a share in [0, 1] of a section.
  [[nodiscard]] Eigen::Vector2d at(std::size_t section, double share) const;
  /// The largest |q| on the arm, as far as small steps along it show.
  [[nodiscard]] double largest_elevation() const { return largest_elevation_; }

 private:
  Backbone backbone_;
  std::vector<std::vector<double>> azimuths_;  // At equal shares of each section, with both ends.
  double largest_elevation_ = 0;
};

/// An experiment's arm as the distributed arm of a task of dynamics, and back. The base is clamped.
class DynamicsPlant {
 public:
  /// For an arm that stands in `from` and has |q| below a quarter turn at its base; where lengths do not vary
  /// they stay as they are there. The task was checked with the arm.
  DynamicsPlant(const DynamicsTask& task, const Arm& arm, const ArmState& from);

  [[nodiscard]] const DistributedArm& distributed() const { return distributed_; }
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  [[nodiscard]] const Eigen::VectorXd& target() const { return target_; }
  /// Whether |q| is below a quarter turn all along the arm at the start.
  [[nodiscard]] bool is_regular() const { return is_regular_; }
  /// By how much the angles that the basis can have differ from those of the shapes where the task starts and
  /// where it is to lead, root mean square along the arm, rad.
  [[nodiscard]] double start_off() const { return start_off_; }
  [[nodiscard]] double target_off() const { return target_off_; }
  /// The largest |q| on the target as the basis has it, rad: a polynomial may go beyond its values.
  [[nodiscard]] double largest_target_elevation() const;
  /// p_WB, m: the distributed arm's places count from there, along W's axes.
  [[nodiscard]] const Eigen::Vector3d& base() const { return arm_.X_WB.position; }

  /// The state of the experiment's arm that has the same directions at the sections' ends; of the
  /// arcs that differ by whole turns, the ones nearest to `before`. In a plane, with an angle that is linear
  /// in each section, this is the same curve.
  [[nodiscard]] ArmState state(const Eigen::VectorXd& x, const ArmState& before) const;
  /// (theta, q) at the sections' ends, rad.
  [[nodiscard]] Eigen::Matrix2Xd end_angles(const Eigen::VectorXd& x) const;

 private:
  using Angles = std::function<Eigen::Vector2d(double s)>;
  [[nodiscard]] Eigen::VectorXd coordinates(const ArmState& state, double& off_by) const;
  [[nodiscard]] double off(const Eigen::VectorXd& x, const Angles& angles) const;

  Arm arm_;
  std::vector<double> stretches_;  // Where they do not vary.
  DistributedArm distributed_;
  Eigen::MatrixXd ends_;  // The shape functions at the sections' ends, the clamp's last.
  Eigen::VectorXd start_, target_;
  double start_off_ = 0, target_off_ = 0;
  bool is_regular_ = true;
};

}  // namespace flexura
