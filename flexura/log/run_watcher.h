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

/// True state of a run's arm, which the ports do not provide.
struct TrueArm {
  Backbone backbone;
  std::vector<double>
      pulled;  ///< Length by which the drives have pulled in each tendon, m; empty: not known.
  std::vector<double> tensions;    ///< Tension of each tendon, N; empty for an arm without forces.
  std::vector<double> lost_steps;  ///< Microsteps lost by each motor; empty if motors cannot lose steps.
  std::optional<EnergyMessage> energy = {};   ///< Energies of an arm with inertia.
  std::vector<ContactMessage> contacts = {};  ///< Contacts of the arm.
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

  /// Receives the arm's state at every clock step, and the measured axis positions of all cameras. `time`:
  /// time of the step, s. If the run simulates no rig, the axis positions are empty: the cameras are at rest.
  virtual void state(double time, const ArmState& state, std::span<const CameraReading> cameras) = 0;
  /// Returns true if the run must call truth() at the next step. The run computes the true arm only in this
  /// case.
  [[nodiscard]] virtual bool needs_truth() { return false; }
  /// Receives the true arm at a clock step, if it is known, after the call of state().
  virtual void truth(double /*time*/, const TrueArm& /*arm*/) {}
  /// Receives an event of the log: `time` in s, level "info", "warning" or "error", source, text.
  virtual void happened(double /*time*/, const std::string& /*level*/, const std::string& /*name*/,
                        const std::string& /*text*/) {}
  /// Receives a task's message as logged; LoggedMessage::as gives its type.
  virtual void logged(const LoggedMessage& /*message*/) {}
  /// The run calls this function after a task that the rig performs has ended.
  virtual void task_ended() {}
};

}  // namespace flexura
