#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/experiment/experiment.h"
#include "flexura/log/run_watcher.h"
#include "flexura/rig/rig.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// Outcome of a run.
enum class RunOutcome {
  done,
  unsafe,     ///< A task would violate a limit of the arm or cause a contact; the run is simulated for
              ///< inspection.
  failed,     ///< A calibration, a servo or a dynamics task failed and ended the run.
  cancelled,  ///< The run was cancelled (Progress::cancelled). The log ends with the last executed step.
};

/// Returns "done", "unsafe", "failed" or "cancelled", the names used in summaries.
[[nodiscard]] const char* name_of(RunOutcome outcome);

/// Result of a run.
struct RunResult {
  RunOutcome outcome = RunOutcome::done;
  std::vector<std::string> reasons;   ///< Reasons why the outcome is not `done`, one line each.
  std::string headline;               ///< Result of the run in one line.
  std::vector<TaskOutcome> outcomes;  ///< Results of the tasks.
  std::filesystem::path folder;       ///< Folder with all files of the run, as given.
  Node summary;                       ///< Content of summary.json.
};

/// Runs an experiment and writes its results into `folder`, which must exist and be empty. An empty `folder`
/// means no files: the run records no pictures and makes no report, but its summary is complete. The results
/// are the experiment as run, the log, the summary, the report and its figures (docs/results.md). Equal
/// experiments write equal bytes, with or without a watcher. A cancelled run writes its results so far,
/// except the report, its figures and tables. `make_rig` makes the rig if cameras are recorded or a task
/// needs a rig. By default `make_rig` makes the rig of the file's equipment, or a simulated rig. Throws
/// InputError if there is no task, and std::runtime_error if a file cannot be written.
[[nodiscard]] RunResult run_experiment(const Experiment& as_read, const std::filesystem::path& folder,
                                       Progress& progress, RunWatcher* watcher = nullptr,
                                       const RigFactory& make_rig = {});

}  // namespace flexura
