#pragma once

#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/report/chart.h"

namespace flexura {

/// Returns charts over time that show the runs of two results folders together. The charts show the tip's
/// coordinates, the distance between the tips, and the true tip if both logs have it. Further charts show the
/// bends of the first eight sections and a servo's error. Throws InputError for a missing or damaged log.
[[nodiscard]] std::vector<ReportFigure> comparison_figures(const std::string& a, const std::string& b,
                                                           Progress& progress);

}  // namespace flexura
