#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/mechanics/rod_energy.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/backbone.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/bend_motion.h"
#include "flexura/sim/drive_motors.h"
#include "flexura/sim/driven_shapes.h"
#include "flexura/sim/plant_contact.h"

namespace flexura {

/// A push at a point of an arm's centerline: a spring towards a fixed point, and a constant force
/// (PointSpring).
struct PlantPush {
  double s_rest = 0;  ///< Pushed point: arc length from the arm's base at rest, m.
  /// Fixed end of the spring in the world frame, m.
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double stiffness = 0;                             ///< Stiffness of the spring, N/m; 0: no spring.
  double most = 1;                                  ///< Upper limit of the spring force, N; > 0.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Constant force, in the world frame, N.

  bool operator==(const PlantPush&) const = default;
};
/// The effect of a push at one time, in the world frame.
struct PlantPushForce {
  double s_rest = 0;                                ///< Pushed point, as in PlantPush, m.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Current position of the pushed point, m.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Force on the arm, N.
};

/// The true arm of the simulated world: computes its response to commands over time.
///
/// For an arm with a drive, a command u has the position of each motor, in microsteps in the motor's own
/// direction. Without a drive, u has bend_x, bend_y and stretch of each section. A plant is not a port: it
/// returns true values, which algorithms must not use.
class Plant {
 public:
  virtual ~Plant() = default;
  Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  /// Commands a motion to u that begins at `time`, s, and takes `duration` s. If this duration is too short,
  /// the motion is as fast as possible. `time` must not be before the last command.
  virtual void command(double time, const Eigen::VectorXd& u, double duration) = 0;
  /// Commands a stop at `time`, s, as fast as possible. `time` must not be before the last command.
  virtual void halt(double time) = 0;
  /// Advances the computation to the rig's time `time`, s, for plants that are integrated step by step. By
  /// default, this function does nothing.
  virtual void advance(double /*time*/) {}
  /// Returns the backbone at `time`, s. `time` must be at most the horizon (PlantSetup) before the rig's
  /// time, and not after the rig's time. Queries change nothing. Several threads may query at once while no
  /// thread commands or advances the plant.
  [[nodiscard]] virtual Backbone backbone(double time) const = 0;
  /// Returns the bends and stretches that the drives impose on the sections. Returns std::nullopt if drives
  /// do not bend sections. Times are as for backbone(), but future times are allowed too.
  [[nodiscard]] virtual std::optional<ArmState> commanded(double /*time*/) const { return std::nullopt; }
  /// Pulls each tendon in to its displacement in `displacements`, m. `time` and `duration` are as for
  /// command(). The displacements replace commanded bends until the next command. Returns the bends of the
  /// nearest arcs. Returns std::nullopt and does nothing if tendons cannot be pulled individually. Throws
  /// std::invalid_argument unless there is one finite number per tendon.
  virtual std::optional<ArmState> pull(double /*time*/, const std::vector<double>& /*displacements*/,
                                       double /*duration*/) {
    return std::nullopt;
  }
  /// Switches the configured weight and loads on or off at `time`, s. `time` must not be before the last
  /// call. Returns false and does nothing if the plant has no such loads.
  virtual bool weigh(double /*time*/, bool /*on*/) { return false; }
  /// Returns whether weight and loads act at a time, s.
  [[nodiscard]] virtual bool is_weighed(double /*time*/) const { return true; }
  /// Applies a push from `time`, s, on; std::nullopt ends the push. `time` must not be before the last call.
  /// Returns false and does nothing if forces do not move the arm. Throws std::invalid_argument for a push
  /// with values that are not finite or out of bounds, or with a point off the arm.
  virtual bool push(double /*time*/, const std::optional<PlantPush>& /*push*/) { return false; }
  /// Returns the push at a time, s. Valid times are the same as for backbone().
  [[nodiscard]] virtual std::optional<PlantPush> pushed(double /*time*/) const { return std::nullopt; }
  /// Returns the effect of the push at a time, s. Valid times are the same as for backbone().
  [[nodiscard]] virtual std::optional<PlantPushForce> push_force(double /*time*/) const {
    return std::nullopt;
  }
  /// Returns by how much the drives have pulled each tendon in, relative to the straight arm, m. Pretension
  /// and lost steps are ignored. Returns an empty vector for plants without individual tendons. Times are as
  /// for backbone().
  [[nodiscard]] virtual std::vector<double> pulled(double /*time*/) const { return {}; }
  /// Returns a one-line warning about an unusual state of the arm; "" if there is none. Times are as for
  /// backbone().
  [[nodiscard]] virtual std::string warning(double /*time*/) const { return {}; }
  /// Returns the tension of each tendon at the arm's base, N; empty if unknown. Valid times are the same as
  /// for backbone().
  [[nodiscard]] virtual std::vector<double> tensions(double /*time*/) const { return {}; }
  /// Returns kinetic energy, strain energy and potential energy of weight and loads. Returns std::nullopt for
  /// an arm without inertia. Valid times are the same as for backbone().
  [[nodiscard]] virtual std::optional<RodEnergy> energy(double /*time*/) const { return std::nullopt; }
  /// Returns the contacts with obstacles and with the arm itself. Valid times are the same as for backbone().
  [[nodiscard]] virtual std::vector<PlantContact> contacts(double /*time*/) const { return {}; }
  /// Returns the number of microsteps that each motor has lost up to a time, s. Controllers do not notice
  /// lost microsteps. Returns an empty vector if motors never lose steps.
  [[nodiscard]] virtual std::vector<double> lost_steps(double /*time*/) const { return {}; }
};

/// Initial conditions of a plant.
struct PlantSetup {
  const ArmSetup& truth;  ///< The true arm. The plant starts in the state `truth.initial`.
  Eigen::VectorXd start;  ///< The initial command u.
  double horizon = 0;     ///< Queries are allowed for this time before the rig's time, s.
};

/// Creates the arm of a simulated world.
using MakePlant = std::function<std::unique_ptr<Plant>(const PlantSetup&)>;

/// A plant whose arm is a chain of arcs. The arm follows the imposed bends without inertia or gravity.
class ArcPlant : public Plant {
 public:
  /// `driven`: the arm in terms of the sections that the drives bend. Throws the exceptions of Actuation.
  explicit ArcPlant(const Arm& driven) : arm_(driven) {}

  /// Returns the bends and stretches that the drives impose on the sections. Future times are allowed.
  [[nodiscard]] virtual ArmState state(double time) const = 0;
  [[nodiscard]] Backbone backbone(double time) const override { return arm_.backbone(state(time)); }
  [[nodiscard]] std::optional<ArmState> commanded(double time) const override { return state(time); }

 private:
  ArmModel arm_;
};

/// An arm that is a chain of arcs, moved by the true motors, spools with backlash, and tendons with friction.
class DrivenPlant : public ArcPlant {
 public:
  /// The setup's truth must have a drive.
  explicit DrivenPlant(const PlantSetup& setup);

  void command(double time, const Eigen::VectorXd& u, double duration) override;
  void halt(double time) override;
  void advance(double time) override { shapes_.advance(time, motors_); }
  [[nodiscard]] ArmState state(double time) const override { return shapes_.at(time, motors_); }

 private:
  DriveMotors motors_;
  DrivenShapes shapes_;
};

/// An arm that is a chain of arcs. The sections bend as commanded, within their own rates.
class BendPlant : public ArcPlant {
 public:
  /// Uses the limits and rates of the true sections.
  explicit BendPlant(const PlantSetup& setup)
      : ArcPlant(setup.truth.arm), bends_(setup.truth.arm, setup.truth.initial, setup.horizon) {}

  void command(double time, const Eigen::VectorXd& u, double duration) override;
  void halt(double time) override { bends_.halt(time); }
  [[nodiscard]] ArmState state(double time) const override { return bends_.at(time); }

 private:
  BendMotion bends_;
};

/// Returns a DrivenPlant if the setup's truth has a drive, otherwise a BendPlant.
[[nodiscard]] std::unique_ptr<Plant> arc_plant(const PlantSetup& setup);

/// Returns (bend_x, bend_y, stretch) of each section.
[[nodiscard]] Eigen::VectorXd plant_command(const ArmState& state);
/// Returns the state given by a command of (bend_x, bend_y, stretch) of each section.
[[nodiscard]] ArmState commanded_state(const Eigen::VectorXd& u);

}  // namespace flexura
