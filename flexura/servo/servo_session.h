#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/control/limiter.h"
#include "flexura/port/rig_model.h"
#include "flexura/port/rig_ports.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_error.h"
#include "flexura/servo/servo_observation.h"
#include "flexura/servo/servo_step.h"

namespace flexura {

/// Largest delay of a picture that is used, s.
inline constexpr double longest_delay = 60;

/// Result of a servo.
struct ServoResult {
  bool is_done = false;          ///< The last target was reached and held for `settle` s.
  std::string reason;            ///< Reason why not; the arm is at rest.
  std::vector<ServoStep> steps;  ///< Empty if the servo keeps no steps.
  /// Number of steps without a command, because their time had passed before the previous step was done.
  long missed_steps = 0;
  double start = 0;                     ///< s
  double missed = 0;                    ///< Largest `missed` of the targets.
  std::optional<double> settled;        ///< Time from the start until the error stays below 2 %, s.
  double overshoot = 0;                 ///< How far the tip went past its target, share of its way.
  std::optional<ServoError> remaining;  ///< Mean over the last `settle` s.
  /// Last observation, command and request before the servo ended early, for any reason; `time` since the
  /// start.
  std::optional<LimiterFault> fault;
  /// First observation, and newest one with a shape; null if missing.
  std::shared_ptr<const ServoObservation> first, last;
};

/// Receives the events of a session. Does not influence it.
class ServoSessionWatcher {
 public:
  virtual ~ServoSessionWatcher() = default;
  ServoSessionWatcher() = default;
  ServoSessionWatcher(const ServoSessionWatcher&) = delete;
  ServoSessionWatcher& operator=(const ServoSessionWatcher&) = delete;

  /// The arm was commanded to `state`, to arrive `duration` s later; `time` in s of the rig's clock. Not
  /// called for refused commands.
  virtual void arm_sent(double time, const ArmState& state, double duration) = 0;
  /// Two simultaneous pictures were measured.
  virtual void seen(const ServoObservation& /*observed*/) {}
  /// A step was done.
  virtual void stepped(const ServoStep& /*step*/) {}
  /// An event for the log: "camera side does not see the arm: ...".
  virtual void reported(double /*time*/, const std::string& /*what*/) {}
  /// Returns true if the servo has to end early.
  virtual bool is_cancelled() { return false; }
};

/// Controls the shape of a rig's arm with two cameras until it reaches the target (docs/servo.md). Each step
/// measures the newest pictures, estimates the arm's shape at their time and computes a command, which the
/// limiter checks. Uses only the ports. After an error, the arm is at rest and the result has the reason.
/// Skips steps whose time has passed, to the next whole step. Equal rigs, readings and pictures give equal
/// results. Throws std::invalid_argument if there are no targets, their times do not increase from 0, or a
/// number is out of range. Also throws it if the ports and the model have different cameras.
[[nodiscard]] ServoResult servo_in_session(const RigPorts& ports, const RigModel& nominal,
                                           const ServoConfig& config, ServoSessionWatcher& watcher);

}  // namespace flexura
