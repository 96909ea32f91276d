#pragma once

#include <string>
#include <variant>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// One line of a chart.
struct ChartSeries {
  std::string name;                ///< For the legend: "3", "X".
  std::vector<double> values;      ///< One a place of x. Where one is no number the line is interrupted.
  std::vector<double> dots = {};   ///< The same from another source, drawn as dots; likewise, or empty.
  std::vector<double> rings = {};  ///< From a third, drawn as rings; likewise.
  std::string css_class = {};      ///< Its colour and dash; empty: by its place in the chart.
};

/// Values over time, or over something else: a plot in the page, a picture as a file.
struct LineChart {
  std::string heading;         ///< "bend of each section"
  std::string x_label;         ///< "t (s)"
  std::string value_label;     ///< "bend_x (deg)"
  double least = 1.0;          ///< The smallest extent of values that is not blown up.
  std::vector<double> x = {};  ///< Ascending; at least one.
  std::vector<ChartSeries> series = {};
  std::string legend = {};         ///< What the series are: "section"; may be empty.
  bool is_of_run = false;          ///< Over the run's times: the page's player marks where it stands.
  std::vector<double> marks = {};  ///< Where fine vertical lines stand.

  /// The style classes of a series.
  [[nodiscard]] std::string class_of(const ChartSeries& one) const;
};

/// A part of a report that is a file of its own, too: "tip-path".
struct ReportFigure {
  std::string name;
  std::variant<Drawing, LineChart> content;
};

/// The chart as a picture.
[[nodiscard]] Drawing chart_picture(const LineChart& chart);

}  // namespace flexura
