#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/experiment/experiment.h"
#include "flexura/log/run_watcher.h"
#include "flexura/rig/rig.h"

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

/// Runs an experiment and writes its results into `folder`, which exists and is empty: the experiment as run,
/// the log, the summary, the report and its figures (docs/results.md). The same experiment writes the same
/// bytes, whether it is watched or not. A run that is cancelled writes what it has come to: all files but the
/// report, its figures and tables. `make_rig` is asked for the rig that plays where cameras are recorded or a
/// task is done by one. Throws InputError when there is no task; std::runtime_error when a file
/// cannot be written.
[[nodiscard]] RunResult run_experiment(const Experiment& as_read, const std::filesystem::path& folder,
                                       Progress& progress, RunWatcher* watcher = nullptr,
                                       const RigFactory& make_rig = simulated_rig);

}  // namespace flexura
