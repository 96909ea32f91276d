#pragma once

#include <string>
#include <variant>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// One line of a chart.
struct ChartSeries {
  std::string name;            ///< For the legend: "3", "X".
  std::vector<double> values;  ///< One per value of x. The line is interrupted at values that are not finite.
  std::vector<double> dots = {};   ///< Values from a second source, drawn as dots; one per x, or empty.
  std::vector<double> rings = {};  ///< Values from a third source, drawn as rings; one per x, or empty.
  std::string css_class = {};      ///< Its colour and dash; empty: by its position in the chart.
};

/// Values over time or another variable: a plot in the page, a picture as a file.
struct LineChart {
  std::string heading;         ///< "bend of each section"
  std::string x_label;         ///< "t (s)"
  std::string value_label;     ///< "bend_x (deg)"
  double least = 1.0;          ///< Least extent of the value axis, so that noise is not enlarged.
  std::vector<double> x = {};  ///< Increasing; at least one.
  std::vector<ChartSeries> series = {};
  std::string legend = {};         ///< Name of the series' variable: "section"; may be empty.
  bool is_of_run = false;          ///< Over the run's times: the page's player marks its time.
  std::vector<double> marks = {};  ///< Positions of fine vertical lines.
  bool is_log = false;  ///< Values are powers of ten; a logarithmic axis shows the numbers themselves.

  /// Returns the label of the value axis, which says whether it is logarithmic.
  [[nodiscard]] std::string axis_label() const { return value_label + (is_log ? ", log scale" : ""); }

  /// Returns the style classes of a series.
  [[nodiscard]] std::string class_of(const ChartSeries& one) const;
};

/// A part of a report that is also a separate file: "tip-path".
struct ReportFigure {
  std::string name;
  std::variant<Drawing, LineChart> content;
};

/// Returns the chart as a picture.
[[nodiscard]] Drawing chart_picture(const LineChart& chart);

}  // namespace flexura
