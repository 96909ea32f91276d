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
#include "flexura/servo/servo_sight.h"
#include "flexura/servo/servo_step.h"

namespace flexura {

/// Pictures that come later than that are not gone by, s.
inline constexpr double longest_delay = 60;

/// How a servo went.
struct ServoResult {
  bool is_done = false;          ///< The last shape was reached, and held for `settle` s.
  std::string reason;            ///< Why it is not; the arm rests.
  std::vector<ServoStep> steps;  ///< None of a servo that keeps none.
  /// Steps whose time had passed before the one before them was done: nothing was sent at these.
  long missed_steps = 0;
  double start = 0;                     ///< s
  double missed = 0;                    ///< The most that a goal's own `missed` is.
  std::optional<double> settled;        ///< Time from the start to 2 % for good, s.
  double overshoot = 0;                 ///< By how much the tip went past its goal, share of its way.
  std::optional<ServoError> remaining;  ///< Mean over the last `settle` s.
  /// What was seen, sent and asked for last before it was given up, for whatever reason; `time` since start.
  std::optional<LimiterFault> fault;
  /// The first of all, and the newest that told a shape; null: there was none.
  std::shared_ptr<const ServoSight> first, last;
};

/// Is told of a session as it goes. What it does with that changes nothing of it.
class ServoSessionWatcher {
 public:
  virtual ~ServoSessionWatcher() = default;
  ServoSessionWatcher() = default;
  ServoSessionWatcher(const ServoSessionWatcher&) = delete;
  ServoSessionWatcher& operator=(const ServoSessionWatcher&) = delete;

  /// The arm was sent to `state`, to arrive `duration` s later; at `time`, s of the rig's clock. What was
  /// refused is not told.
  virtual void arm_sent(double time, const ArmState& state, double duration) = 0;
  /// Two pictures of one instant were measured.
  virtual void seen(const ServoSight& /*sight*/) {}
  /// A step was done.
  virtual void stepped(const ServoStep& /*step*/) {}
  /// Something happened that is worth a line: "camera side does not see the arm: ...".
  virtual void told(double /*time*/, const std::string& /*what*/) {}
  /// Whether the servo shall end early.
  virtual bool is_cancelled() { return false; }
};

/// Steers the shape of a rig's arm by two cameras until it is the wanted one (docs/servo.md): the newest
/// pictures are measured, the shape of the arm at their time is estimated, the law says where to send it, a
/// limiter stands between. Everything goes through the ports; what goes wrong ends with the arm at rest and
/// says why. Steps whose time has passed are left out: the next one is at the next whole step. The same rig,
/// readings and pictures give the same result. std::invalid_argument: no goals, goals whose times do not rise
/// from 0, numbers out of range, ports for other cameras than the model's.
[[nodiscard]] ServoResult servo_in_session(const RigPorts& ports, const RigModel& believed,
                                           const ServoConfig& config, ServoSessionWatcher& watcher);

}  // namespace flexura
