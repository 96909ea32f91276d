#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "flexura/report/report.h"
#include "flexura/tasks/calibrate/calibrate_run.h"

namespace flexura {

/// One measured offset of a camera in one of the paper's methods.
struct LoopOffset {
  std::string quantity;  ///< Name with camera and unit: "horizontal orientation of front (px)".
  const LoopDecision* first = nullptr;  ///< First decision on this offset; never null.
  const LoopDecision* last = nullptr;   ///< Last decision on this offset; never null.

  /// Returns true if the last offset is within its tolerance.
  [[nodiscard]] bool is_reached() const { return std::abs(last->offset) <= last->accepted; }
};

/// Returns the offsets of a calibration by one of the paper's methods, in the order in which the method first
/// decided on them.
[[nodiscard]] std::vector<LoopOffset> loop_offsets(const CalibrationRun& run);

/// Returns the table of a successful calibration: one row per quantity. A row has the value at the start, the
/// value after the calibration, the true value in the simulation, the tolerance, and whether the tolerance is
/// met.
[[nodiscard]] ChapterTable calibration_table(const CalibrationRun& run);

}  // namespace flexura
