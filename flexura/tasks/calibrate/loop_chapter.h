#pragma once

#include <cstddef>

#include "flexura/report/report.h"
#include "flexura/tasks/calibrate/calibrate_run.h"

namespace flexura {

/// Returns the chapter of a calibration by one of the paper's methods in a report: decreasing offsets, and
/// pictures before and after (the paper's Fig. 15). `number` from 0, for the names of figures.
[[nodiscard]] Chapter loop_chapter(const CalibrationRun& run, std::size_t number);

}  // namespace flexura
