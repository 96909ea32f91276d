#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/experiment/experiment.h"

namespace flexura {

/// How a run ended.
enum class RunOutcome {
  done,
  unsafe,  ///< A task would break a limit of the arm or touch something; simulated to be looked at.
};

/// What a run says of itself at its end.
struct RunResult {
  RunOutcome outcome = RunOutcome::done;
  std::vector<std::string> reasons;  ///< Why it is not done, a line each.
  std::filesystem::path folder;
  Node summary;  ///< As in summary.json.
};

/// Runs an experiment and writes its results into `folder`, which exists and is empty: the experiment as run,
/// the log, the summary, the report and its figures (docs/results.md). The same experiment writes the same
/// bytes. Throws InputError when there is no task; std::runtime_error when a file cannot be written.
[[nodiscard]] RunResult run_experiment(const Experiment& as_read, const std::filesystem::path& folder,
                                       Progress& progress);

}  // namespace flexura
