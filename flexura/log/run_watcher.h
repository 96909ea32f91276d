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

/// True state of a run's arm, which its ports do not give.
struct TrueArm {
  Backbone backbone;
  std::vector<double> pulled;      ///< How far its drives have each tendon pulled in, m; empty: not known.
  std::vector<double> tensions;    ///< N; empty: of an arm without forces.
  std::vector<double> lost_steps;  ///< Microsteps of each motor; empty: none ever.
  std::optional<EnergyMessage> energy = {};   ///< Of an arm in motion.
  std::vector<ContactMessage> contacts = {};  ///< Where it touches something.
};

/// Axis positions that a camera's head and stage report.
struct CameraReading {
  HeadState head;
  StageState stage;
};

/// Observes a run on the run's thread. Does not influence the run.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  RunWatcher() = default;
  RunWatcher(const RunWatcher&) = delete;
  RunWatcher& operator=(const RunWatcher&) = delete;

  /// Receives the arm's state at every clock step, s, and the cameras' readings at that time, in their order.
  /// The readings are empty if the run plays no rig; its cameras are then at rest.
  virtual void state(double time, const ArmState& state, std::span<const CameraReading> cameras) = 0;
  /// Returns true if the truth is needed at the next step: it takes time to compute.
  [[nodiscard]] virtual bool needs_truth() { return false; }
  /// Receives the true arm at a clock step, if known, after its state.
  virtual void truth(double /*time*/, const TrueArm& /*arm*/) {}
  /// Receives an event of the log: `time` in s, level "info", "warning" or "error", source, text.
  virtual void happened(double /*time*/, const std::string& /*level*/, const std::string& /*name*/,
                        const std::string& /*text*/) {}
  /// Receives a task's message as logged; LoggedMessage::as gives its type.
  virtual void logged(const LoggedMessage& /*message*/) {}
  /// A task of the rig has ended.
  virtual void task_ended() {}
};

}  // namespace flexura
