#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/port/outcome.h"

namespace flexura {

/// What the numbers of a drive are, one an axis: those that it takes, and those that it says.
enum class DriveQuantity {
  motor_positions,       ///< Of the motors, in microsteps and each in its own sense (kinematics/motors.h).
  tendon_displacements,  ///< How far each tendon is pulled in, m (TendonDisplacements).
  tendon_tensions,       ///< By which each tendon pulls, N.
};

/// What a drive says of itself.
struct DriveReading {
  double time = 0;             ///< s, when it was true.
  std::vector<double> values;  ///< Where each axis is, in the drive's quantity.
  /// The same of what is behind the play of each axis, by a drive that follows its play (of motor positions
  /// only); empty: the drive leaves that to others.
  std::vector<double> carried;
  bool moving = false;  ///< A commanded motion is under way or still to come.
};

/// What a motion controller does: it takes a target for each axis, and knows nothing of arms. The axes are
/// those of a Drive, in its order. Commands return at once, motion takes time; a command replaces the one
/// before. Targets that an axis cannot take are drawn to the nearest that it can.
class DrivePort {
 public:
  virtual ~DrivePort() = default;
  DrivePort() = default;
  DrivePort(const DrivePort&) = delete;
  DrivePort& operator=(const DrivePort&) = delete;

  /// What it takes and says. One and the same, always.
  [[nodiscard]] virtual DriveQuantity quantity() const = 0;
  [[nodiscard]] virtual std::size_t axes() const = 0;
  /// Sends each axis to its target, to arrive together `duration` s from now, or each as soon after that as
  /// it can; 0 is as soon as each can. Refused: another number of targets, a target that is not finite, a
  /// duration that is negative or not finite.
  [[nodiscard]] virtual CommandOutcome command(std::span<const double> targets, double duration) = 0;
  /// As fast as the axes can.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Where the axes are now. Moves nothing.
  [[nodiscard]] virtual Outcome<DriveReading> read() = 0;
};

}  // namespace flexura
