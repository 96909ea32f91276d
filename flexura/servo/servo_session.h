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
  std::string reason;            ///< Reason why the servo failed, with the arm at rest, or "".
  std::vector<ServoStep> steps;  ///< Empty if the servo keeps no steps.
  /// Number of skipped steps: their time had passed before the previous step was done.
  long missed_steps = 0;
  double start = 0;               ///< Start of the servo, s of the rig's clock.
  double missed = 0;              ///< Largest ServoGoal::missed of the targets, share of the arm's length.
  std::optional<double> settled;  ///< Time from the start until the error stays below 2 %, s.
  double overshoot =
      0;  ///< Distance by which the tip passed its target, as a share of the tip's way to the target.
  std::optional<ServoError> remaining;  ///< Mean error over the last `settle` s.
  /// Standard deviation of the last observed shape, root mean square along the arm, share of its length. It
  /// follows from the last pictures alone; empty if no shape was observed.
  std::optional<double> sigma;
  /// Last observation, command and request before the servo ended early, for any reason. `time` counts from
  /// the servo's start.
  std::optional<LimiterFault> fault;
  /// The first and the newest observation with a shape; null if there is none.
  std::shared_ptr<const ServoObservation> first, last;
};

/// Receives the events of a session. Does not influence it.
class ServoSessionWatcher {
 public:
  virtual ~ServoSessionWatcher() = default;
  ServoSessionWatcher() = default;
  ServoSessionWatcher(const ServoSessionWatcher&) = delete;
  ServoSessionWatcher& operator=(const ServoSessionWatcher&) = delete;

  /// The arm was commanded to reach `state` after `duration` s. `time`: time of the command, s of the rig's
  /// clock. Not called for refused commands.
  virtual void arm_sent(double time, const ArmState& state, double duration) = 0;
  /// Two simultaneous pictures were measured.
  virtual void seen(const ServoObservation& /*observed*/) {}
  /// A step was done.
  virtual void stepped(const ServoStep& /*step*/) {}
  /// An event for the log, such as "camera side does not see the arm: ...".
  virtual void reported(double /*time*/, const std::string& /*what*/) {}
  /// Returns true to end the servo early.
  virtual bool is_cancelled() { return false; }
};

/// Controls the shape of a rig's arm with two cameras until it reaches the target (docs/servo.md). Each step
/// measures the newest pictures, estimates the arm's shape at their time and computes a command, which the
/// limiter checks. Uses only the ports. After an error, the arm is brought to rest and the result has the
/// reason. Steps whose time has passed are skipped. Equal rigs, readings and pictures give equal results.
/// Throws std::invalid_argument if there are no targets, if their times do not increase from 0, or if a
/// number is out of range. Also throws it if the ports and the model have different cameras.
[[nodiscard]] ServoResult servo_in_session(const RigPorts& ports, const RigModel& nominal,
                                           const ServoConfig& config, ServoSessionWatcher& watcher);

}  // namespace flexura
