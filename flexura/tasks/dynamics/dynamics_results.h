#pragma once

#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/tasks/dynamics/dynamics_run.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// Returns what came of it: how far the tip is from its target, and whether the energy fell as in theory.
[[nodiscard]] TaskOutcome dynamics_outcome(const DynamicsRun& run);

/// Returns its item in the list `dynamics` of a summary.
[[nodiscard]] Node dynamics_node(const DynamicsRun& run);

/// Returns the chapter of a task of kind "dynamics" in a report: whether the Lyapunov function decreased as
/// in theory, and why not. Has charts of it, the energies and the errors over time. `number` from 0, for the
/// names of figures.
[[nodiscard]] Chapter dynamics_chapter(const DynamicsRun& run, std::size_t number);

}  // namespace flexura
