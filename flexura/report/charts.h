#pragma once

#include <vector>

#include "flexura/report/chart.h"
#include "flexura/report/motion.h"

namespace flexura {

/// More sections than these are thinned in a chart.
inline constexpr std::size_t max_series = 32;

/// What a report plots over time: bends, archings and cord angles (an arm in XOY), stretches (where they
/// change) and the tip's coordinates, named so. Angles in degrees, lengths in m.
[[nodiscard]] std::vector<ReportFigure> charts_of(const ReportMotion& motion);

}  // namespace flexura
