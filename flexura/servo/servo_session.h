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

/// Largest allowed delay of pictures, s.
inline constexpr double longest_delay = 60;

/// Result of a servo.
struct ServoResult {
  bool is_done = false;          ///< Whether the arm reached the last target and stayed there for `settle` s.
  std::string reason;            ///< Reason why the servo failed, or "". After a failure, the arm is at rest.
  std::vector<ServoStep> steps;  ///< Steps of the servo; empty unless ServoConfig::keeps_steps.
  /// Number of skipped steps. A step is skipped if the previous step ends after the time of this step.
  long missed_steps = 0;
  double start = 0;   ///< Start of the servo, s of the rig's clock.
  double missed = 0;  ///< Largest ServoGoal::missed of the targets, share of the arm's length.
  /// Time from the start after which the error stays below 2 % of the length, s.
  std::optional<double> settled;
  double overshoot =
      0;  ///< Overshoot of the tip beyond its target, as a share of the tip's path to the target.
  std::optional<ServoError> remaining;  ///< Mean error over the last `settle` s.
  /// Standard deviation of the last observed shape, root mean square along the arm, share of its length. The
  /// value is computed from the last pictures only; empty if no shape was observed.
  std::optional<double> sigma;
  /// If the servo ended early: its last observation, last command and the law's last request.
  /// `time` counts from the servo's start.
  std::optional<LimiterFault> fault;
  /// First and last observation with a shape; null without such observations.
  std::shared_ptr<const ServoObservation> first, last;
};

/// Receives the events of a session. Does not influence the session.
class ServoSessionWatcher {
 public:
  virtual ~ServoSessionWatcher() = default;
  ServoSessionWatcher() = default;
  ServoSessionWatcher(const ServoSessionWatcher&) = delete;
  ServoSessionWatcher& operator=(const ServoSessionWatcher&) = delete;

  /// The session calls this function after it has commanded the arm to reach `state` in `duration` s. `time`:
  /// time of the command, s of the rig's clock. The session does not call this function for refused commands.
  virtual void arm_sent(double time, const ArmState& state, double duration) = 0;
  /// The session calls this function after it has measured two simultaneous pictures.
  virtual void seen(const ServoObservation& /*observed*/) {}
  /// Called after each step.
  virtual void stepped(const ServoStep& /*step*/) {}
  /// The session calls this function with an event for the log, such as "camera side does not see the arm:
  /// ...".
  virtual void reported(double /*time*/, const std::string& /*what*/) {}
  /// Returns true to end the servo early.
  virtual bool is_cancelled() { return false; }
};

/// Controls the shape of a rig's arm with two cameras until it reaches the target (docs/servo.md). Each step
/// measures the newest pictures, estimates the arm's shape at the pictures' time and computes a command,
/// which the limiter checks. Uses only the ports. After an error, brings the arm to rest and returns the
/// reason in the result. Skips steps whose time is over. Equal rigs, readings and pictures give equal
/// results. Throws std::invalid_argument if there are no targets, if their times do not increase from 0, or
/// if a number is out of range. Also throws std::invalid_argument if the ports and the model have different
/// cameras.
[[nodiscard]] ServoResult servo_in_session(const RigPorts& ports, const RigModel& nominal,
                                           const ServoConfig& config, ServoSessionWatcher& watcher);

}  // namespace flexura
