#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/port/outcome.h"

namespace flexura {

/// Physical quantity of a drive's targets and readings, which have one number per axis.
enum class DriveQuantity {
  motor_positions,  ///< Motor positions, microsteps, in each motor's own direction (kinematics/motors.h).
  tendon_displacements,  ///< Length by which each tendon is pulled in, m (TendonDisplacements).
  tendon_tensions,       ///< Tension of each tendon, N.
};

/// Reading of a drive.
struct DriveReading {
  double time = 0;             ///< Time of the measurement, s.
  std::vector<double> values;  ///< Measured value of each axis, in the drive's quantity.
  /// Load position of each axis, which includes the backlash, microsteps. Empty, unless the drive has motor
  /// positions and tracks its backlash.
  std::vector<double> carried;
  bool moving = false;  ///< Whether a commanded motion is in progress or pending.
};

/// A motion controller. A DrivePort moves each axis to a target and needs no model of the arm. The axes are
/// the axes of a Drive, in the drive's order. Commands return before the motion is completed. A command
/// replaces the previous command. Targets outside an axis's range are clamped.
class DrivePort {
 public:
  virtual ~DrivePort() = default;
  DrivePort() = default;
  DrivePort(const DrivePort&) = delete;
  DrivePort& operator=(const DrivePort&) = delete;

  /// Returns the quantity of targets and readings, which never changes.
  [[nodiscard]] virtual DriveQuantity quantity() const = 0;
  [[nodiscard]] virtual std::size_t axes() const = 0;
  /// Moves each axis to its target. All axes arrive at the same time after `duration`, s. An axis that needs
  /// longer arrives as soon as possible. With duration 0, the axes arrive as soon as possible. The command is
  /// refused if the number of targets is wrong, a target is not finite, or the duration is negative or not
  /// finite.
  [[nodiscard]] virtual CommandOutcome command(std::span<const double> targets, double duration) = 0;
  /// Stops all axes as fast as possible.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Returns the current reading of all axes, without moving anything.
  [[nodiscard]] virtual Outcome<DriveReading> read() = 0;
};

}  // namespace flexura
