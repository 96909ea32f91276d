#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/messages.h"
#include "flexura/model/arm.h"

namespace flexura {

/// How a run ended.
enum class RunOutcome {
  done,
  unsafe,     ///< A task would break a limit of the arm or touch something; simulated to be looked at.
  failed,     ///< A calibration, a servo or a task of dynamics was not done, and ended the run.
  cancelled,  ///< Progress::cancelled: the log ends with the last step that was played.
};

/// "done", "unsafe", "failed", "cancelled", as summaries have it.
[[nodiscard]] const char* name_of(RunOutcome outcome);

/// What a run says of itself at its end.
struct RunResult {
  RunOutcome outcome = RunOutcome::done;
  std::vector<std::string> reasons;  ///< Why it is not done, a line each.
  std::filesystem::path folder;      ///< As it was given: all files are in it.
  Node summary;                      ///< As in summary.json.
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
  /// An event of the log: at `time` s, "info", "warning" or "error", of whom, and what.
  virtual void happened(double /*time*/, const std::string& /*level*/, const std::string& /*name*/,
                        const std::string& /*text*/) {}
  /// A command of a calibration, what it sees in a picture, and what it decides, as the log has them; the
  /// last decision ends it.
  virtual void calibration_moved(const CalibrationMoveMessage& /*move*/) {}
  virtual void calibration_saw(const CalibrationSightingMessage& /*sighting*/) {}
  virtual void calibration_decided(const CalibrationDecisionMessage& /*decision*/) {}
  /// What a servo sends, and what it sees in a picture, as the log has them; and that it has ended.
  virtual void servo_stepped(const ServoStepMessage& /*step*/) {}
  virtual void servo_saw(const ServoSightingMessage& /*sighting*/) {}
  virtual void servo_ended() {}
};

/// Runs an experiment and writes its results into `folder`, which exists and is empty: the experiment as run,
/// the log, the summary, the report and its figures (docs/results.md). The same experiment writes the same
/// bytes, whether it is watched or not. A run that is cancelled writes what it has come to: all files but the
/// report, its figures and tables. Throws InputError when there is no task; std::runtime_error when a file
/// cannot be written.
[[nodiscard]] RunResult run_experiment(const Experiment& as_read, const std::filesystem::path& folder,
                                       Progress& progress, RunWatcher* watcher = nullptr);

}  // namespace flexura
