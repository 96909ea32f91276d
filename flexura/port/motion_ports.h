#pragma once

#include <cstdint>
#include <vector>

#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/model/arm.h"
#include "flexura/port/outcome.h"

// What moves. Commands return at once, motion takes time; a command replaces the one before, whether its
// motion is over or not. Positions that a device cannot take are drawn to the nearest one that it can; a
// command with a number that is not finite is refused, and nothing moves.
namespace flexura {

/// What the drives of an arm say of themselves.
struct ArmReading {
  double time = 0;  ///< s, when it was true.
  /// The shape that the model makes of the drives' positions: what the arm is believed to be.
  ArmState state;
  std::vector<std::int64_t> positions;  ///< Of the motors, microsteps; empty for an arm without drives.
  bool moving = false;                  ///< A commanded motion is under way or still to come.
};

/// An arm and its drives, simulated or real.
class ArmPort {
 public:
  virtual ~ArmPort() = default;
  ArmPort() = default;
  ArmPort(const ArmPort&) = delete;
  ArmPort& operator=(const ArmPort&) = delete;

  /// Sends the drives to where the model has this shape, to arrive together `duration` s from now, or each as
  /// soon after that as it can; 0 is as soon as each can. A motion is followed by commands that each last
  /// until the next one. Refused besides: a duration that is negative or not finite.
  [[nodiscard]] virtual CommandOutcome command(const ArmState& state, double duration) = 0;
  /// As fast as the drives can.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// What the drives say now. Moves nothing.
  [[nodiscard]] virtual Outcome<ArmReading> read() = 0;
};

/// Where a head says that it stands: its motors, in steps of their resolution.
struct HeadReading {
  double time = 0;  ///< s, when it was true.
  HeadState state;
  bool moving = false;  ///< A commanded motion is under way or still to come.
};

/// A camera's pan/tilt head and its zoom.
class HeadPort {
 public:
  virtual ~HeadPort() = default;
  HeadPort() = default;
  HeadPort(const HeadPort&) = delete;
  HeadPort& operator=(const HeadPort&) = delete;

  /// Sends pan, tilt (rad) and zoom (a position of the lens's table), each for itself as fast as it can.
  [[nodiscard]] virtual CommandOutcome command(const HeadState& state) = 0;
  /// As fast as the motors can.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// What the motors say now. Moves nothing.
  [[nodiscard]] virtual Outcome<HeadReading> read() = 0;
};

/// Where a stage says that it stands.
struct StageReading {
  double time = 0;  ///< s, when it was true.
  StageState state;
  bool moving = false;  ///< A commanded motion is under way or still to come.
};

/// What a camera's head is moved along by.
class StagePort {
 public:
  virtual ~StagePort() = default;
  StagePort() = default;
  StagePort(const StagePort&) = delete;
  StagePort& operator=(const StagePort&) = delete;

  /// Sends the mount's offset, m along its axes, each for itself as fast as it can.
  [[nodiscard]] virtual CommandOutcome command(const StageState& state) = 0;
  /// As fast as the motors can.
  [[nodiscard]] virtual CommandOutcome halt() = 0;
  /// What the motors say now. Moves nothing.
  [[nodiscard]] virtual Outcome<StageReading> read() = 0;
};

}  // namespace flexura
