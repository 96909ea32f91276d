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
#include "flexura/sim/plant_contact.h"

namespace flexura {

/// A push at a point of an arm's centerline: a spring towards a place, and a constant force (PointSpring).
struct PlantPush {
  double s_rest = 0;  ///< Pushed point: arc length from the arm's base at rest, m.
  /// Position of the spring's other end in the world frame, m.
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double stiffness = 0;                             ///< Stiffness of the spring, N/m; 0: no spring.
  double most = 1;                                  ///< Upper limit of the spring force, N; > 0.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Constant force, in the world frame, N.

  bool operator==(const PlantPush&) const = default;
};
/// The effect of a push at an instant, in the world frame.
struct PlantPushForce {
  double s_rest = 0;                                ///< Pushed point, as in PlantPush, m.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Current position of that point, m.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Force on the arm, N.
};

/// The true arm of the simulated world: computes its response to commands over time.
///
/// For an arm with a drive, a command u consists of the position of each motor, in microsteps in the motor's
/// own sense. Without a drive, it consists of (bend_x, bend_y, stretch) of each section. A plant is not a
/// port: it returns true values, which algorithms must not use.
class Plant {
 public:
  virtual ~Plant() = default;
  Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  /// From `time` s on, moves to u within `duration` s, or as fast as possible if that is too short. `time` is
  /// not before the last command.
  virtual void command(double time, const Eigen::VectorXd& u, double duration) = 0;
  /// Stops as fast as possible at `time` s, which is not before the last command.
  virtual void halt(double time) = 0;
  /// Advances the computation to the rig's time `time`, s, for plants that are integrated step by step. A
  /// plant that is a function of time and its commands does nothing here.
  virtual void advance(double /*time*/) {}
  /// Returns the backbone at `time` s, between the horizon (PlantSetup) before the rig's time and the rig's
  /// time. Queries change nothing. Several threads may query at once while nobody commands or advances.
  [[nodiscard]] virtual Backbone backbone(double time) const = 0;
  /// Returns the section state that the drives impose, as the drives see it. Returns std::nullopt if drives
  /// do not bend sections. Times as for backbone(), and future times as far as commanded.
  [[nodiscard]] virtual std::optional<ArmState> commanded(double /*time*/) const { return std::nullopt; }
  /// Pulls each tendon in to `displacements`, m, at `time` s, not before the last command. Timing is as for
  /// command(). This overrides commanded bends until the next command. Returns the bends of the nearest arcs.
  /// Returns std::nullopt and does nothing if tendons cannot be pulled individually. Throws
  /// std::invalid_argument unless there is one finite number per tendon.
  virtual std::optional<ArmState> pull(double /*time*/, const std::vector<double>& /*displacements*/,
                                       double /*duration*/) {
    return std::nullopt;
  }
  /// Switches the configured weight and loads on or off from `time` s on, not before the last such call.
  /// Returns false and does nothing if the plant has no such loads.
  virtual bool weigh(double /*time*/, bool /*on*/) { return false; }
  /// Returns whether weight and loads act at that time.
  [[nodiscard]] virtual bool is_weighed(double /*time*/) const { return true; }
  /// Applies a push from `time` s on, not before the last such call; std::nullopt ends the push. Returns
  /// false and does nothing if the arm does not yield to forces. Throws std::invalid_argument for a push with
  /// values that are not finite or out of bounds, or with a point off the arm.
  virtual bool push(double /*time*/, const std::optional<PlantPush>& /*push*/) { return false; }
  /// Returns the push at that time. Times as for backbone().
  [[nodiscard]] virtual std::optional<PlantPush> pushed(double /*time*/) const { return std::nullopt; }
  /// Returns the effect of the push at that time. Times as for backbone().
  [[nodiscard]] virtual std::optional<PlantPushForce> push_force(double /*time*/) const {
    return std::nullopt;
  }
  /// Returns how far the drives have pulled each tendon in from the straight arm, m, ignoring pretension and
  /// lost steps. Returns an empty vector if individual tendons are not known. Times as for backbone().
  [[nodiscard]] virtual std::vector<double> pulled(double /*time*/) const { return {}; }
  /// Returns a one-line warning about an unusual state of the arm; "" if there is none. Times as for
  /// backbone().
  [[nodiscard]] virtual std::string warning(double /*time*/) const { return {}; }
  /// Returns the tension of each tendon at the arm's base, N; empty if unknown. Times as for backbone().
  [[nodiscard]] virtual std::vector<double> tensions(double /*time*/) const { return {}; }
  /// Returns kinetic energy, strain energy and potential energy of weight and loads. Returns std::nullopt for
  /// an arm without inertia. Times as for backbone().
  [[nodiscard]] virtual std::optional<RodEnergy> energy(double /*time*/) const { return std::nullopt; }
  /// Returns the contacts with obstacles and with the arm itself. Times as for backbone().
  [[nodiscard]] virtual std::vector<PlantContact> contacts(double /*time*/) const { return {}; }
  /// Returns the microsteps that each motor has lost up to that time, unknown to its controller. Returns an
  /// empty vector if steps are never lost.
  [[nodiscard]] virtual std::vector<double> lost_steps(double /*time*/) const { return {}; }
};

/// Initial conditions of a plant.
struct PlantSetup {
  const ArmSetup& truth;  ///< The true arm, which starts in `initial`.
  Eigen::VectorXd start;  ///< The initial command u.
  double horizon = 0;     ///< Time before the rig's time for which queries are allowed, s.
};

/// Creates the arm of a simulated world.
using MakePlant = std::function<std::unique_ptr<Plant>(const PlantSetup&)>;

/// A plant whose arm is a chain of arcs and follows the imposed bends without inertia or gravity.
class ArcPlant : public Plant {
 public:
  /// `driven`: the arm as its drives actuate it. Errors as Actuation.
  explicit ArcPlant(const Arm& driven) : arm_(driven) {}

  /// Returns the state that the drives impose on the sections, also for future times as far as commanded.
  [[nodiscard]] virtual ArmState state(double time) const = 0;
  [[nodiscard]] Backbone backbone(double time) const override { return arm_.backbone(state(time)); }
  [[nodiscard]] std::optional<ArmState> commanded(double time) const override { return state(time); }

 private:
  ArmModel arm_;
};

/// A chain of arcs behind true motors, spools, backlash and tendons.
class DrivenPlant : public ArcPlant {
 public:
  /// Requires that the truth has a drive.
  explicit DrivenPlant(const PlantSetup& setup);

  void command(double time, const Eigen::VectorXd& u, double duration) override;
  void halt(double time) override { motors_.halt(time); }
  [[nodiscard]] ArmState state(double time) const override;

 private:
  Arm arm_;
  Drive drive_;
  DriveMotors motors_;
  std::vector<double> zero_;  // Tendon displacements at motor position 0, m.
};

/// A chain of arcs whose sections bend as commanded, within their own bend rates.
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
