#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/log/messages.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

class LoggedMessage;

/// How the arm of a run truly stands, which its ports do not say.
struct TrueArm {
  Backbone backbone;
  std::vector<double> pulled;      ///< How far its drives have each tendon pulled in, m; empty: not known.
  std::vector<double> tensions;    ///< N; empty: of an arm without forces.
  std::vector<double> lost_steps;  ///< Microsteps of each motor; empty: none ever.
  std::optional<EnergyMessage> energy = {};   ///< Of an arm in motion.
  std::vector<ContactMessage> contacts = {};  ///< Where it touches something.
};

/// Where a camera's head and stage say that they stand.
struct CameraReading {
  HeadState head;
  StageState stage;
};

/// Sees a run as it plays, on the run's thread. What it does with that changes nothing of the run.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  RunWatcher() = default;
  RunWatcher(const RunWatcher&) = delete;
  RunWatcher& operator=(const RunWatcher&) = delete;

  /// The arm's state at every step of the clock, s, and what is read from the cameras then, in their order:
  /// of none where the run plays no rig, whose cameras stand still.
  virtual void state(double time, const ArmState& state, std::span<const CameraReading> cameras) = 0;
  /// Whether it wants to be told the truth at the next step: to find that out takes a while.
  [[nodiscard]] virtual bool wants_truth() { return false; }
  /// How the arm truly stands at a step of the clock, where that is known: after its state.
  virtual void truth(double /*time*/, const TrueArm& /*arm*/) {}
  /// An event of the log: at `time` s, "info", "warning" or "error", of whom, and what.
  virtual void happened(double /*time*/, const std::string& /*level*/, const std::string& /*name*/,
                        const std::string& /*text*/) {}
  /// A message of a task, as the log has it: LoggedMessage::as says of which type.
  virtual void logged(const LoggedMessage& /*message*/) {}
  /// A task that was done by the rig has ended.
  virtual void task_ended() {}
};

}  // namespace flexura
