#pragma once

#include <cstdint>
#include <vector>

#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/model/arm.h"
#include "flexura/port/outcome.h"

// Ports of moving devices. Commands return before the motion is completed. A command replaces the previous
// command, even during its motion. Positions outside a device's range are clamped. A command with a number
// that is not finite is refused, and nothing moves.
namespace flexura {

/// Reading of an arm's drives.
struct ArmReading {
  double time = 0;  ///< Time of the measurement, s.
  /// Shape that the model computes from the drives' positions.
  ArmState state;
  std::vector<std::int64_t> positions;  ///< Motor positions, microsteps; empty for an arm without a drive.
  bool moving = false;                  ///< Whether a commanded motion is in progress or pending.
};

/// An arm and its drives, simulated or real.
class ArmPort {
 public:
  virtual ~ArmPort() = default;
  ArmPort() = default;
  ArmPort(const ArmPort&) = delete;
  ArmPort& operator=(const ArmPort&) = delete;

  /// Moves the drives to the positions for which the model predicts the shape `state`. All drives arrive at
  /// the same time after `duration`, s. A drive that needs longer arrives as soon as possible. With duration
  /// 0, the drives arrive as soon as possible. For continuous motion, each command's duration should last
  /// until the next command. A duration that is negative or not finite is also refused.
  [[nodiscard]] virtual CommandOutcome command(const ArmState& state, double duration) = 0;
  /// Stops all drives as fast as possible.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Returns the drives' current reading, without moving anything.
  [[nodiscard]] virtual Outcome<ArmReading> read() = 0;
};

/// Reading of a head: measured axis positions, with the resolution of the motors.
struct HeadReading {
  double time = 0;  ///< Time of the measurement, s.
  HeadState state;
  bool moving = false;  ///< Whether a commanded motion is in progress or pending.
};

/// A camera's pan/tilt/zoom head.
class HeadPort {
 public:
  virtual ~HeadPort() = default;
  HeadPort() = default;
  HeadPort(const HeadPort&) = delete;
  HeadPort& operator=(const HeadPort&) = delete;

  /// Commands pan and tilt, rad, and the zoom position. Each axis moves independently, as fast as possible.
  [[nodiscard]] virtual CommandOutcome command(const HeadState& state) = 0;
  /// Stops all motors as fast as possible.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Returns the motors' current reading, without moving anything.
  [[nodiscard]] virtual Outcome<HeadReading> read() = 0;
};

/// Reading of a stage.
struct StageReading {
  double time = 0;  ///< Time of the measurement, s.
  StageState state;
  bool moving = false;  ///< Whether a commanded motion is in progress or pending.
};

/// A stage that translates a camera's head.
class StagePort {
 public:
  virtual ~StagePort() = default;
  StagePort() = default;
  StagePort(const StagePort&) = delete;
  StagePort& operator=(const StagePort&) = delete;

  /// Commands the mount's offset along its axes, m. Each axis moves independently, as fast as possible.
  [[nodiscard]] virtual CommandOutcome command(const StageState& state) = 0;
  /// Stops all motors as fast as possible.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Returns the motors' current reading, without moving anything.
  [[nodiscard]] virtual Outcome<StageReading> read() = 0;
};

}  // namespace flexura
