#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "flexura/model/arm_difference.h"
#include "flexura/model/backbone.h"
#include "flexura/port/driven_arm.h"
#include "flexura/port/motion_ports.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/bend_motion.h"
#include "flexura/sim/simulated_drive.h"
#include "flexura/sim/simulated_link.h"
#include "flexura/sim/true_plant.h"

namespace flexura {

/// An arm without drives that moves its sections to commanded shapes. The measured shape of this arm depends
/// only on the commands and the rates of the sections.
class SimulatedBends : public ArmPort {
 public:
  /// The arguments are as for SimulatedArm. The plant must outlive this object.
  SimulatedBends(const ArmSetup& model, const ArmSetup& truth, Plant& plant, const ClockPort& clock,
                 double horizon);

  CommandOutcome command(const ArmState& state, double duration) override;
  CommandOutcome halt() override;
  Outcome<ArmReading> read() override;
  /// Implements SimulatedArm::pull().
  CommandOutcome pull(const std::vector<double>& displacements, double duration);
  /// Returns the link to the arm. The link can be interrupted temporarily.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  Arm arm_;
  BendMotion bends_;
  ArmDifference offset_;  // True bends and stretches minus those of the model.
  Plant& plant_;
};

/// The arm of a simulated world and its control. With a drive, a controller that uses the model moves the arm
/// (DrivenArm). Without a drive, the sections move at their own rates.
class SimulatedArm : public ArmPort {
 public:
  /// At the start, the motors are at the positions for the model's initial shape, and the true arm has its
  /// own initial shape. The true state can be queried back to `horizon` s before the last command. Throws
  /// std::invalid_argument if truth and model do not match (truth_problem).
  SimulatedArm(const ArmSetup& model, const ArmSetup& truth, const ClockPort& clock, double horizon,
               const MakePlant& make_plant = true_plant);

  CommandOutcome command(const ArmState& state, double duration) override;
  CommandOutcome halt() override;
  Outcome<ArmReading> read() override;

  /// Pulls each tendon in to the given displacement, m. With a drive, the axes pull the tendons; without a
  /// drive, Plant::pull() pulls the tendons. `duration` is as for command(). Refuses the command if the arm
  /// has no tendons to pull, or unless there is one finite displacement per tendon.
  CommandOutcome pull(const std::vector<double>& displacements, double duration);

  /// Returns the true bends and stretches that the drives impose; not for algorithms. `time`, s, must be at
  /// most the horizon before the last command. Throws std::logic_error if the plant has no such state
  /// (Plant::commanded).
  [[nodiscard]] ArmState truth(double time) const;
  /// Returns the backbone of the true arm; not for algorithms.
  [[nodiscard]] Backbone backbone(double time) const { return plant_->backbone(time); }
  /// Returns the true arm; not for algorithms.
  [[nodiscard]] Plant& plant() { return *plant_; }
  /// Returns the link to the arm. The link can be interrupted temporarily.
  [[nodiscard]] SimulatedLink& link() { return drive_ ? drive_->link() : bends_->link(); }
  /// Returns the simulated controller of the drive; null without a drive.
  [[nodiscard]] SimulatedDrive* drive() { return drive_ ? &*drive_ : nullptr; }

 private:
  std::unique_ptr<Plant> plant_;
  std::optional<SimulatedDrive> drive_;
  std::optional<DrivenArm> driven_;
  std::optional<SimulatedBends> bends_;
  ArmPort* port_ = nullptr;  // Points to driven_ or bends_.
};

}  // namespace flexura
