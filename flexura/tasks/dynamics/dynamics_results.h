#pragma once

#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/tasks/dynamics/dynamics_run.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// Returns the result of the task in words: the tip's distance from its target, and whether the energy
/// decreased as in theory.
[[nodiscard]] TaskOutcome dynamics_outcome(const DynamicsRun& run);

/// Returns the task's item in the list `dynamics` of a summary.
[[nodiscard]] Node dynamics_node(const DynamicsRun& run);

/// Returns the report's chapter of a task of kind "dynamics". The chapter states whether the Lyapunov
/// function decreased as in theory, and if not, why. The chapter has charts of this function, the energies
/// and the errors. `number`: index among the tasks of this kind, from 0, for names of figures.
[[nodiscard]] Chapter dynamics_chapter(const DynamicsRun& run, std::size_t number);

}  // namespace flexura
