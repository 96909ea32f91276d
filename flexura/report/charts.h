#pragma once

#include <vector>

#include "flexura/report/chart.h"
#include "flexura/report/motion.h"

namespace flexura {

/// Most sections in a chart; more are thinned out.
inline constexpr std::size_t max_series = 32;

/// Returns the charts of a report over time: bends, archings and cord angles (an arm in XOY), stretches (if
/// they change) and the tip's coordinates, with these names. Angles in degrees, lengths in m.
[[nodiscard]] std::vector<ReportFigure> charts_of(const ReportMotion& motion);

}  // namespace flexura
