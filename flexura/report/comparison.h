#pragma once

#include <string>
#include <vector>

#include "flexura/report/chart.h"
#include "flexura/report/report.h"

namespace flexura {

/// Data of a page that compares two runs.
struct ComparisonData {
  std::string a, b;                    ///< Any texts: names of the runs.
  std::string headline_a, headline_b;  ///< Any texts: what came of each; "" if unknown.
  std::string version;                 ///< Version of Flexura.
  std::vector<std::string> notes;      ///< Any texts.
  ChapterTable table;                  ///< Differing values.
  std::vector<ReportFigure> figures;   ///< Charts with both runs; names unique in the page.
};

/// Returns the page: HTML that loads nothing and runs nothing.
[[nodiscard]] std::string comparison_html(const ComparisonData& data);

/// A quantity over time.
struct TimedValues {
  std::vector<double> times;   ///< In s, increasing.
  std::vector<double> values;  ///< One per time.
};

/// Returns two courses over time as a chart with the lines A and B. Both are interpolated linearly at at most
/// 2000 common times; a line is interrupted where its run has no values. `least`: as in LineChart. Throws
/// std::invalid_argument if both are empty.
[[nodiscard]] LineChart overlaid_chart(std::string heading, std::string label, double least,
                                       const TimedValues& a, const TimedValues& b);

}  // namespace flexura
