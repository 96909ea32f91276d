#pragma once

#include <cstddef>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/experiment/servo_run.h"
#include "flexura/report/report.h"

namespace flexura {

/// The list `servos` of a summary.
[[nodiscard]] Node servo_nodes(const std::vector<ServoRun>& runs);

/// A servo in a report: errors falling, and what the cameras saw first and last with the wanted shape in it.
/// `number` from 0, for the names of figures.
[[nodiscard]] Chapter servo_chapter(const ServoRun& run, std::size_t number);

}  // namespace flexura
