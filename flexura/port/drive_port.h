#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/port/outcome.h"

namespace flexura {

/// Quantity of a drive's targets and readings, one number per axis.
enum class DriveQuantity {
  motor_positions,  ///< Motor positions, microsteps, in each motor's own direction (kinematics/motors.h).
  tendon_displacements,  ///< Length by which each tendon is pulled in, m (TendonDisplacements).
  tendon_tensions,       ///< Tension of each tendon, N.
};

/// Reading of a drive.
struct DriveReading {
  double time = 0;             ///< Time at which it was true, s.
  std::vector<double> values;  ///< Position of each axis, in the drive's quantity.
  /// Positions behind the backlash of each axis, in the drive's quantity. Only from a drive of motor
  /// positions that follows its backlash; otherwise empty.
  std::vector<double> carried;
  bool moving = false;  ///< A commanded motion is in progress or pending.
};

/// A motion controller: takes a target for each axis and needs no model of the arm. The axes are those of a
/// Drive, in its order. Commands return at once; the motion takes time. A command replaces the previous one.
/// Targets out of an axis's range are clamped.
class DrivePort {
 public:
  virtual ~DrivePort() = default;
  DrivePort() = default;
  DrivePort(const DrivePort&) = delete;
  DrivePort& operator=(const DrivePort&) = delete;

  /// Returns the quantity of targets and readings. It never changes.
  [[nodiscard]] virtual DriveQuantity quantity() const = 0;
  [[nodiscard]] virtual std::size_t axes() const = 0;
  /// Sends each axis to its target. All arrive together `duration` s from now, or each as soon after that as
  /// possible; 0 means as soon as possible. Refused: a wrong number of targets, a target that is not finite,
  /// or a duration that is negative or not finite.
  [[nodiscard]] virtual CommandOutcome command(std::span<const double> targets, double duration) = 0;
  /// Stops as fast as the axes can.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Returns the axes' current positions. Moves nothing.
  [[nodiscard]] virtual Outcome<DriveReading> read() = 0;
};

}  // namespace flexura
