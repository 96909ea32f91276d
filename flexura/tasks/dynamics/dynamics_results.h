#pragma once

#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/tasks/dynamics/dynamics_run.h"

namespace flexura {

/// Its entry in the list `dynamics` of a summary.
[[nodiscard]] Node dynamics_node(const DynamicsRun& run);

/// A task of dynamics in a report: whether Lyapunov's function fell as the theory has it, and why not; it,
/// the energies and the errors over time. `number` from 0, for the names of figures.
[[nodiscard]] Chapter dynamics_chapter(const DynamicsRun& run, std::size_t number);

}  // namespace flexura
