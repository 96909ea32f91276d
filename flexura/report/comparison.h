#pragma once

#include <string>
#include <vector>

#include "flexura/report/chart.h"
#include "flexura/report/report.h"

namespace flexura {

/// Data of a page that compares two runs.
struct ComparisonData {
  std::string a, b;                    ///< Names of the runs; any texts.
  std::string headline_a, headline_b;  ///< Results of the runs in one line; any texts; "" if unknown.
  std::string version;                 ///< Version of Flexura.
  std::vector<std::string> notes;      ///< Notes on the comparison; any texts.
  ChapterTable table;                  ///< Values that differ between the runs.
  std::vector<ReportFigure> figures;   ///< Charts of both runs, with different names.
};

/// Returns the page as HTML that loads no other file and runs no script.
[[nodiscard]] std::string comparison_html(const ComparisonData& data);

/// A quantity over time.
struct TimedValues {
  std::vector<double> times;   ///< Times, s, increasing.
  std::vector<double> values;  ///< Values, one per time.
};

/// Returns a chart of one quantity in two runs, with the lines A and B. Both lines are interpolated linearly
/// at common times, at most 2000. A line is interrupted where its run has no values. `least`:
/// LineChart::least. Throws std::invalid_argument if `a` and `b` are both empty.
[[nodiscard]] LineChart overlaid_chart(std::string heading, std::string label, double least,
                                       const TimedValues& a, const TimedValues& b);

}  // namespace flexura
