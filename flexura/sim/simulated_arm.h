#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "flexura/kinematics/motors.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/arm_way.h"
#include "flexura/model/backbone.h"
#include "flexura/port/motion_ports.h"
#include "flexura/sim/axis_motion.h"
#include "flexura/sim/bend_motion.h"
#include "flexura/sim/rig_config.h"
#include "flexura/sim/simulated_link.h"

namespace flexura {

/// The motors of a simulated drive. Commands and readings go by what the model believes of tendons and
/// spools, the arm by what is true: its motors' rates, its play, its tendons.
class SimulatedDrive {
 public:
  /// Both arms stand in their initial shapes when the motors are where the model puts its own. The truth is
  /// known back to `horizon` s before the last command. Both setups have a drive, of as many axes.
  SimulatedDrive(const ArmSetup& model, const ArmSetup& truth, double horizon);

  /// At `time` s: to this shape of the model's within `duration` s, or as soon after that as each motor can.
  /// False when a motor's position could not be counted; nothing moves then.
  [[nodiscard]] bool command(double time, const ArmState& state, double duration);
  /// The motors brake as fast as they can.
  void halt(double time);
  /// What the model makes of the motors.
  [[nodiscard]] ArmReading reading(double time) const;
  /// The shape of the true arm, known back to the horizon: not for algorithms.
  [[nodiscard]] ArmState truth(double time) const;

 private:
  ArmSetup model_, truth_;
  MotorCommander commander_;
  // In microsteps pulled in, of the believed and the true spool; the same motors.
  std::vector<AxisMotion> believed_, true_;
  // Displacements where the motors are at 0, m.
  std::vector<double> believed_zero_, true_zero_;
};

/// An arm that follows commands as its drives can, or, where it has none, as its sections' bend rates allow.
class SimulatedArm : public ArmPort {
 public:
  /// std::invalid_argument when the truth is another arm (truth_problem).
  SimulatedArm(const ArmSetup& model, const ArmSetup& truth, const ClockPort& clock, double horizon);

  CommandOutcome command(const ArmState& state, double duration) override;
  CommandOutcome halt() override;
  Outcome<ArmReading> read() override;

  /// What the true arm is commanded to by its drives as they are, from `horizon` s before the last command
  /// on: not for algorithms.
  [[nodiscard]] ArmState truth(double time) const;
  /// The true arm's; not for algorithms.
  [[nodiscard]] Backbone backbone(double time) const { return arm_.backbone(truth(time)); }
  /// What connects the arm: it can be lost for a time.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  ArmModel arm_;   // as it is
  ArmWay offset_;  // without drives: true bends and stretches less believed ones
  std::variant<SimulatedDrive, BendMotion> moved_by_;
};

}  // namespace flexura
