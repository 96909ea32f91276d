#pragma once

#include <cstddef>

#include "flexura/base/progress.h"
#include "flexura/base/work_progress.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"

namespace flexura {

/// Progress of a run as the share of its work that is done. The work has these parts: the checks, the report,
/// and for each task its simulation, its execution and its results.
class RunProgress {
 public:
  RunProgress(Progress& whole, const Experiment& experiment, const TaskRunners& tasks);

  [[nodiscard]] Progress& checks() { return work_.piece(0); }
  [[nodiscard]] Progress& report() { return work_.piece(1); }
  /// Returns the progress of the simulation of task `i` before the run.
  [[nodiscard]] Progress& simulation(std::size_t i) { return work_.piece(2 + 3 * i); }
  /// Returns the progress of task `i` while it is played or performed.
  [[nodiscard]] Progress& task(std::size_t i) { return work_.piece(3 + 3 * i); }
  /// Returns the progress of task `i` while it computes its results.
  [[nodiscard]] Progress& results(std::size_t i) { return work_.piece(4 + 3 * i); }

 private:
  WorkProgress work_;
};

}  // namespace flexura
