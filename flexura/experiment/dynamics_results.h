#pragma once

#include <cstddef>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/experiment/dynamics_run.h"
#include "flexura/report/report.h"

namespace flexura {

/// The list `dynamics` of a summary.
[[nodiscard]] Node dynamics_nodes(const std::vector<DynamicsRun>& runs);

/// A task of dynamics in a report: whether Lyapunov's function fell as the theory has it, and why not; it,
/// the energies and the errors over time. `number` from 0, for the names of figures.
[[nodiscard]] Chapter dynamics_chapter(const DynamicsRun& run, std::size_t number);

}  // namespace flexura
