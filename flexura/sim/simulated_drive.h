#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"
#include "flexura/port/drive_port.h"
#include "flexura/sim/drive_motors.h"
#include "flexura/sim/plant.h"
#include "flexura/sim/simulated_link.h"

namespace flexura {

/// The controller of a simulated drive. The controller counts the microsteps of its motors, and sends its
/// commands also to the plant's true motors. The load positions that it reports are computed with the model's
/// backlash.
class SimulatedDrive : public DrivePort {
 public:
  /// Starts at rest at the motor positions `start`, microsteps. Motors have the limits of `real`. The plant
  /// must outlive this object.
  SimulatedDrive(const Drive& nominal, const Drive& real, const std::vector<std::int64_t>& start,
                 Plant& plant, const ClockPort& clock, double horizon);

  [[nodiscard]] DriveQuantity quantity() const override { return DriveQuantity::motor_positions; }
  [[nodiscard]] std::size_t axes() const override { return motors_.axes(); }
  CommandOutcome command(std::span<const double> targets, double duration) override;
  CommandOutcome halt() override;
  Outcome<DriveReading> read() override;

  /// Returns the link to the drive. The link can be interrupted temporarily.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  DriveMotors motors_;
  Plant& plant_;
};

}  // namespace flexura
