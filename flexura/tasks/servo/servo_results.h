#pragma once

#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/tasks/servo/servo_run.h"
#include "flexura/tasks/task_outcome.h"

namespace flexura {

/// Returns the result of the servo in words: the time until it converged and the remaining error.
[[nodiscard]] TaskOutcome servo_outcome(const ServoRun& run);

/// Returns the servo's item in the list `servos` of a summary.
[[nodiscard]] Node servo_node(const ServoRun& run);

/// Returns the servo's targets for the report's 3D view, with times in [0, duration] s from its start. A
/// moving target is represented by several targets at successive times.
[[nodiscard]] std::vector<ReportSpace::Target> servo_targets(const ServoRun& run, double duration);

/// Returns the report's chapter of a servo: the errors over time, and the first and last pictures with the
/// target shape. `number`: index among the servos, from 0, for names of figures.
[[nodiscard]] Chapter servo_chapter(const ServoRun& run, std::size_t number);

}  // namespace flexura
