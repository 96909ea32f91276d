#pragma once

#include <cstdint>
#include <vector>

#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/model/arm.h"
#include "flexura/port/outcome.h"

// Moving devices. Commands return at once; the motion takes time. A command replaces the previous one, even
// during its motion. Positions out of a device's range are clamped. A command with a number that is not
// finite is refused, and nothing moves.
namespace flexura {

/// Reading of an arm's drives.
struct ArmReading {
  double time = 0;  ///< Time at which it was true, s.
  /// Shape that the model computes from the drives' positions.
  ArmState state;
  std::vector<std::int64_t> positions;  ///< Motor positions, microsteps; empty for an arm without drives.
  bool moving = false;                  ///< A commanded motion is in progress or pending.
};

/// An arm and its drives, simulated or real.
class ArmPort {
 public:
  virtual ~ArmPort() = default;
  ArmPort() = default;
  ArmPort(const ArmPort&) = delete;
  ArmPort& operator=(const ArmPort&) = delete;

  /// Moves the drives to where the model has this shape. All arrive together `duration` s from now, or each
  /// as soon after that as possible; 0 means as soon as possible. For continuous motion, send commands that
  /// each last until the next one. Also refused: a duration that is negative or not finite.
  [[nodiscard]] virtual CommandOutcome command(const ArmState& state, double duration) = 0;
  /// Stops as fast as the drives can.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Returns the drives' current reading. Moves nothing.
  [[nodiscard]] virtual Outcome<ArmReading> read() = 0;
};

/// Reading of a head: its motor positions, in steps of their resolution.
struct HeadReading {
  double time = 0;  ///< Time at which it was true, s.
  HeadState state;
  bool moving = false;  ///< A commanded motion is in progress or pending.
};

/// A camera's pan/tilt head and its zoom.
class HeadPort {
 public:
  virtual ~HeadPort() = default;
  HeadPort() = default;
  HeadPort(const HeadPort&) = delete;
  HeadPort& operator=(const HeadPort&) = delete;

  /// Commands pan and tilt (rad) and zoom (a position in the lens's table). Each axis moves by itself, as
  /// fast as it can.
  [[nodiscard]] virtual CommandOutcome command(const HeadState& state) = 0;
  /// Stops as fast as the motors can.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Returns the motors' current reading. Moves nothing.
  [[nodiscard]] virtual Outcome<HeadReading> read() = 0;
};

/// Reading of a stage.
struct StageReading {
  double time = 0;  ///< Time at which it was true, s.
  StageState state;
  bool moving = false;  ///< A commanded motion is in progress or pending.
};

/// A stage that translates a camera's head.
class StagePort {
 public:
  virtual ~StagePort() = default;
  StagePort() = default;
  StagePort(const StagePort&) = delete;
  StagePort& operator=(const StagePort&) = delete;

  /// Commands the mount's offset, m along its axes. Each axis moves by itself, as fast as it can.
  [[nodiscard]] virtual CommandOutcome command(const StageState& state) = 0;
  /// Stops as fast as the motors can.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// Returns the motors' current reading. Moves nothing.
  [[nodiscard]] virtual Outcome<StageReading> read() = 0;
};

}  // namespace flexura
