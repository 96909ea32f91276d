#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// One line of a chart.
struct ChartSeries {
  std::string name;                  ///< Short and without spaces, for the legend: "3", "X".
  std::string css_class;             ///< Its colour and dash.
  std::vector<double> values;        ///< One a time. Where one is no number the line is interrupted.
  std::vector<double> dots = {};     ///< The same from another source, drawn as dots; likewise, or empty.
  std::vector<double> crosses = {};  ///< From a third, drawn as crosses; likewise.
};

/// Values over time, or over something else.
struct LineChart {
  std::string name;         ///< "bends": names the file, and tells the page's script what it shows.
  std::string heading;      ///< "bend of each section"
  std::string value_label;  ///< "bend_x (deg)"
  std::string legend;       ///< What the series are: "section"; may be empty.
  double least = 1.0;       ///< The smallest extent of values that is not blown up.
  std::vector<ChartSeries> series;
  std::string x_label = {};  ///< What takes the time's place; empty: the time.

  [[nodiscard]] bool is_over_time() const { return x_label.empty(); }
};

/// Draws the chart over `times` (s, or what x_label says; ascending), with a fine vertical line at each of
/// `event_times`. Its body is one group; over time it has the class "chart" and says where the plot is, for
/// the page's script.
[[nodiscard]] Drawing chart_picture(const LineChart& chart, const std::vector<double>& times,
                                    const std::vector<double>& event_times);

}  // namespace flexura
