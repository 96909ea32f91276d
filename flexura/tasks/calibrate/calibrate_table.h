#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "flexura/report/report.h"
#include "flexura/tasks/calibrate/calibrate_run.h"

namespace flexura {

/// One measured offset of a camera in one of the paper's methods.
struct LoopOffset {
  std::string quantity;                 ///< With camera and unit: "horizontal orientation of front (px)".
  const LoopDecision* first = nullptr;  ///< Never null.
  const LoopDecision* last = nullptr;   ///< Never null.

  /// Returns true if the last one is within its tolerance.
  [[nodiscard]] bool is_reached() const { return std::abs(last->offset) <= last->accepted; }
};

/// Returns the offsets of a calibration by one of the paper's methods, in the order of their first decisions.
[[nodiscard]] std::vector<LoopOffset> loop_offsets(const CalibrationRun& run);

/// Returns the table of a successful calibration: a row per quantity, with its value at the start, after the
/// calibration and in the simulated truth, its tolerance, and whether that is reached.
[[nodiscard]] ChapterTable calibration_table(const CalibrationRun& run);

}  // namespace flexura
