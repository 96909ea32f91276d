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

/// An arm without drives, which sends its sections to shapes and says how they stand by their rates alone.
class SimulatedBends : public ArmPort {
 public:
  /// As SimulatedArm says. The plant outlives it.
  SimulatedBends(const ArmSetup& model, const ArmSetup& truth, Plant& plant, const ClockPort& clock,
                 double horizon);

  CommandOutcome command(const ArmState& state, double duration) override;
  CommandOutcome halt() override;
  Outcome<ArmReading> read() override;
  /// As SimulatedArm's.
  CommandOutcome pull(const std::vector<double>& displacements, double duration);
  /// What connects it: it can be lost for a time.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  Arm arm_;
  BendMotion bends_;
  ArmDifference offset_;  // true bends and stretches less believed ones
  Plant& plant_;
};

/// The arm of a simulated world with what moves it: a drive's controller with what is believed of it
/// (DrivenArm), or, where there is no drive, its sections' own rates.
class SimulatedArm : public ArmPort {
 public:
  /// Both arms stand in their initial shapes when the motors are where the model puts its own. The truth is
  /// known back to `horizon` s before the last command. std::invalid_argument when the truth is another arm
  /// (truth_problem).
  SimulatedArm(const ArmSetup& model, const ArmSetup& truth, const ClockPort& clock, double horizon,
               const MakePlant& make_plant = true_plant);

  CommandOutcome command(const ArmState& state, double duration) override;
  CommandOutcome halt() override;
  Outcome<ArmReading> read() override;

  /// Sends each tendon to be pulled in so far, m: behind a drive by its axes, else of a plant that takes that
  /// (Plant::pull). `duration` as command() says. Refused: of another arm, or not one finite displacement a
  /// tendon.
  CommandOutcome pull(const std::vector<double>& displacements, double duration);

  /// What the true arm is commanded to by its drives as they are, from `horizon` s before the last command
  /// on: not for algorithms. std::logic_error: the plant has none (Plant::commanded).
  [[nodiscard]] ArmState truth(double time) const;
  /// The true arm's; not for algorithms.
  [[nodiscard]] Backbone backbone(double time) const { return plant_->backbone(time); }
  /// The arm as it truly is: likewise.
  [[nodiscard]] Plant& plant() { return *plant_; }
  /// What connects the arm: it can be lost for a time.
  [[nodiscard]] SimulatedLink& link() { return drive_ ? drive_->link() : bends_->link(); }
  /// The controller of its drive, below its port; null without a drive.
  [[nodiscard]] SimulatedDrive* drive() { return drive_ ? &*drive_ : nullptr; }

 private:
  std::unique_ptr<Plant> plant_;
  std::optional<SimulatedDrive> drive_;
  std::optional<DrivenArm> driven_;
  std::optional<SimulatedBends> bends_;
  ArmPort* port_ = nullptr;  // one of the two
};

}  // namespace flexura
