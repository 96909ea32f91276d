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

/// How a hand pushes an arm: at a point of its middle line, by a spring to a place and by a constant force
/// (PointSpring).
struct PlantPush {
  double s_rest = 0;                                ///< The point: arc length from the arm's base at rest, m.
  Eigen::Vector3d to = Eigen::Vector3d::Zero();     ///< The spring's other end, in the world, m.
  double stiffness = 0;                             ///< Of the spring, N/m; 0: there is none.
  double most = 1;                                  ///< It pulls no more than this, N; > 0.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< The constant force, in the world, N.

  bool operator==(const PlantPush&) const = default;
};
/// What a push does at an instant, in the world.
struct PlantPushForce {
  double s_rest = 0;                                ///< As PlantPush's, m.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Where that point is, m.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< On the arm, N.
};

/// The arm of the simulated world, as it truly is: what commands make of it over time.
///
/// A command u has, for an arm behind a drive, a position for each motor (microsteps, in its own sense), else
/// for each section its (bend_x, bend_y, stretch). What a plant makes of it is its own affair: it is no port
/// and tells the truth, which is not for algorithms.
class Plant {
 public:
  virtual ~Plant() = default;
  Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  /// At `time` s, not before the last command: goes to u within `duration` s, or as soon after that as it
  /// can.
  virtual void command(double time, const Eigen::VectorXd& u, double duration) = 0;
  /// Stops as fast as it can. Times likewise.
  virtual void halt(double time) = 0;
  /// The rig's time has come to `time` s: what follows from step to step goes on up to there. A plant that is
  /// a function of time and its commands has nothing to do.
  virtual void advance(double /*time*/) {}
  /// How the arm stands, back to the horizon (PlantSetup) before the rig's time, and up to that time. Asking
  /// changes nothing. Several threads may ask at once, while nobody commands or advances.
  [[nodiscard]] virtual Backbone backbone(double time) const = 0;
  /// What its sections are bent to, as the drives see it. None: it has no sections that drives bend. Times as
  /// backbone(), and what is to come as far as commanded.
  [[nodiscard]] virtual std::optional<ArmState> commanded(double /*time*/) const { return std::nullopt; }
  /// At `time` s, not before the last command: each tendon goes to be pulled in so far, m, as command() says,
  /// whatever bends were commanded; the next command takes over again. It gives the bends to which arcs would
  /// come nearest to that. None: it has no tendons that are pulled one by one beside commands, and does
  /// nothing. std::invalid_argument: not one finite number a tendon.
  virtual std::optional<ArmState> pull(double /*time*/, const std::vector<double>& /*displacements*/,
                                       double /*duration*/) {
    return std::nullopt;
  }
  /// From `time` s on, not before the last such call: with or without the weight and the loads that it was
  /// given. false: it has none, and does nothing.
  virtual bool weigh(double /*time*/, bool /*on*/) { return false; }
  /// Whether these pull then.
  [[nodiscard]] virtual bool is_weighed(double /*time*/) const { return true; }
  /// From `time` s on, not before the last such call: something pushes the arm so; none: nothing does any
  /// more. false: it is no arm that yields to forces, and does nothing. std::invalid_argument: a push whose
  /// numbers are not finite or out of bounds, or at no point of the arm.
  virtual bool push(double /*time*/, const std::optional<PlantPush>& /*push*/) { return false; }
  /// That push then. Times as backbone().
  [[nodiscard]] virtual std::optional<PlantPush> pushed(double /*time*/) const { return std::nullopt; }
  /// What it does then. Times as backbone().
  [[nodiscard]] virtual std::optional<PlantPushForce> push_force(double /*time*/) const {
    return std::nullopt;
  }
  /// How far its drives have each tendon pulled in, m, from the straight arm on (a pretension and lost steps
  /// are not in that). Empty: it has no tendons that are known one by one. Times as backbone().
  [[nodiscard]] virtual std::vector<double> pulled(double /*time*/) const { return {}; }
  /// What is out of the ordinary in how it rests, one line; "": nothing. Times as backbone().
  [[nodiscard]] virtual std::string warning(double /*time*/) const { return {}; }
  /// By which each tendon pulls at the arm's base, N. Empty: nobody knows. Times as backbone().
  [[nodiscard]] virtual std::vector<double> tensions(double /*time*/) const { return {}; }
  /// Kinetic, of its strains, and of its weight and loads. None: it has no inertia. Times as backbone().
  [[nodiscard]] virtual std::optional<RodEnergy> energy(double /*time*/) const { return std::nullopt; }
  /// Where it touches obstacles and itself. Times as backbone().
  [[nodiscard]] virtual std::vector<PlantContact> contacts(double /*time*/) const { return {}; }
  /// How many microsteps each motor has lost up to then, of which its controller knows nothing. Empty: none
  /// ever.
  [[nodiscard]] virtual std::vector<double> lost_steps(double /*time*/) const { return {}; }
};

/// What a plant begins with.
struct PlantSetup {
  const ArmSetup& truth;  ///< The arm as it truly is, which stands in `initial`,
  Eigen::VectorXd start;  ///< at this u.
  double horizon = 0;     ///< How far back it is asked for, s.
};

/// Makes the arm of a simulated world.
using MakePlant = std::function<std::unique_ptr<Plant>(const PlantSetup&)>;

/// An arm that is a chain of arcs: what drives bend, it follows without inertia or gravity.
class ArcPlant : public Plant {
 public:
  /// The arm as its drives see it. Errors as Actuation's.
  explicit ArcPlant(const Arm& driven) : arm_(driven) {}

  /// What its sections are bent to, as the drives see it; known in what is to come too, as far as commanded.
  [[nodiscard]] virtual ArmState state(double time) const = 0;
  [[nodiscard]] Backbone backbone(double time) const override { return arm_.backbone(state(time)); }
  [[nodiscard]] std::optional<ArmState> commanded(double time) const override { return state(time); }

 private:
  ArmModel arm_;
};

/// Such an arm behind true motors, spools, play and tendons.
class DrivenPlant : public ArcPlant {
 public:
  /// The truth has a drive.
  explicit DrivenPlant(const PlantSetup& setup);

  void command(double time, const Eigen::VectorXd& u, double duration) override;
  void halt(double time) override { motors_.halt(time); }
  [[nodiscard]] ArmState state(double time) const override;

 private:
  Arm arm_;
  Drive drive_;
  DriveMotors motors_;
  std::vector<double> zero_;  // displacements where the motors are at 0, m
};

/// Such an arm whose sections bend by themselves, as their rates allow.
class BendPlant : public ArcPlant {
 public:
  /// Its sections obey the limits and rates of the truth's.
  explicit BendPlant(const PlantSetup& setup)
      : ArcPlant(setup.truth.arm), bends_(setup.truth.arm, setup.truth.initial, setup.horizon) {}

  void command(double time, const Eigen::VectorXd& u, double duration) override;
  void halt(double time) override { bends_.halt(time); }
  [[nodiscard]] ArmState state(double time) const override { return bends_.at(time); }

 private:
  BendMotion bends_;
};

/// The one of the two that the setup's truth is.
[[nodiscard]] std::unique_ptr<Plant> arc_plant(const PlantSetup& setup);

/// (bend_x, bend_y, stretch) of each section.
[[nodiscard]] Eigen::VectorXd plant_command(const ArmState& state);
/// The state of such a command.
[[nodiscard]] ArmState commanded_state(const Eigen::VectorXd& u);

}  // namespace flexura
