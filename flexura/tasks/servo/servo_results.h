#pragma once

#include <cstddef>

#include "flexura/base/node.h"
#include "flexura/report/report.h"
#include "flexura/tasks/servo/servo_run.h"

namespace flexura {

/// Its entry in the list `servos` of a summary.
[[nodiscard]] Node servo_node(const ServoRun& run);

/// A servo in a report: errors falling, and what the cameras saw first and last with the wanted shape in it.
/// `number` from 0, for the names of figures.
[[nodiscard]] Chapter servo_chapter(const ServoRun& run, std::size_t number);

}  // namespace flexura
