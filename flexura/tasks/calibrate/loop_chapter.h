#pragma once

#include <cstddef>

#include "flexura/report/report.h"
#include "flexura/tasks/calibrate/calibrate_run.h"

namespace flexura {

/// Returns the report's chapter on a calibration by one of the paper's methods. The chapter has the offsets
/// over time, and pictures from before and after the calibration (the paper's Fig. 15). `number`: index among
/// the calibrations, from 0, for names of figures.
[[nodiscard]] Chapter loop_chapter(const CalibrationRun& run, std::size_t number);

}  // namespace flexura
