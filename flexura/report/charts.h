#pragma once

#include <vector>

#include "flexura/report/chart.h"
#include "flexura/report/motion.h"

namespace flexura {

/// Largest number of sections in a chart. Further sections are omitted.
inline constexpr std::size_t max_series = 32;

/// Returns the charts of a report over time: bends, archings and cord angles (of an arm in XOY), stretches
/// (if they change) and the tip's coordinates. Each figure has the name of its quantity. Angles are in
/// degrees, lengths in m.
[[nodiscard]] std::vector<ReportFigure> charts_of(const ReportMotion& motion);

}  // namespace flexura
