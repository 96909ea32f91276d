#pragma once

#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/tasks/servo/servo_run.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// Returns what came of it: the time it took and the error that remains.
[[nodiscard]] TaskOutcome servo_outcome(const ServoRun& run);

/// Returns its item in the list `servos` of a summary.
[[nodiscard]] Node servo_node(const ServoRun& run);

/// Returns the chapter of a servo in a report: decreasing errors, and the first and last pictures with the
/// target shape. `number` from 0, for the names of figures.
[[nodiscard]] Chapter servo_chapter(const ServoRun& run, std::size_t number);

}  // namespace flexura
