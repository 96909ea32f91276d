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

/// The controller of a simulated drive: it counts the microsteps of motors, and sends the true ones, which
/// are the plant's, to the same positions. What is behind their play it says by the play that it believes in.
class SimulatedDrive : public DrivePort {
 public:
  /// At rest at `start`, microsteps. Its motors obey the limits of `real`'s. The plant outlives it.
  SimulatedDrive(const Drive& nominal, const Drive& real, const std::vector<std::int64_t>& start,
                 Plant& plant, const ClockPort& clock, double horizon);

  [[nodiscard]] DriveQuantity quantity() const override { return DriveQuantity::motor_positions; }
  [[nodiscard]] std::size_t axes() const override { return motors_.axes(); }
  CommandOutcome command(std::span<const double> targets, double duration) override;
  CommandOutcome halt() override;
  Outcome<DriveReading> read() override;

  /// What connects it: it can be lost for a time.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  SimulatedLink link_;
  DriveMotors motors_;
  Plant& plant_;
};

}  // namespace flexura
