#pragma once

#include <string>
#include <variant>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// One line of a chart.
struct ChartSeries {
  std::string name;  ///< Name in the legend, such as "3" or "X".
  std::vector<double>
      values;  ///< Values, one per value of x. The line is interrupted at values that are not finite.
  std::vector<double> dots = {};   ///< Values from a second source, drawn as dots; one per x, or empty.
  std::vector<double> rings = {};  ///< Values from a third source, drawn as rings; one per x, or empty.
  std::string css_class =
      {};  ///< Style class for colour and dash; empty: chosen by the position in the chart.
};

/// A chart of values over time or another variable. In the page, the chart is an interactive plot. In a file
/// of its own, the chart is a picture.
struct LineChart {
  std::string heading;      ///< Heading, such as "bend of each section".
  std::string x_label;      ///< Name of the x axis, such as "t (s)".
  std::string value_label;  ///< Name of the value axis, such as "bend_x (deg)".
  double least = 1.0;  ///< Smallest extent of the value axis, so that small noise does not fill the chart.
  std::vector<double> x = {};  ///< Values of x, increasing; at least one.
  std::vector<ChartSeries> series = {};
  std::string legend =
      {};  ///< Name of the variable that distinguishes the series, such as "section"; may be empty.
  bool is_of_run =
      false;  ///< Whether x are times of the run, so that the page's player marks its time in the chart.
  std::vector<double> marks = {};  ///< Positions of fine vertical lines.
  bool is_log =
      false;  ///< Whether values are exponents of ten, so that a logarithmic axis shows powers of ten.

  /// Returns the label of the value axis, which states whether the axis is logarithmic.
  [[nodiscard]] std::string axis_label() const { return value_label + (is_log ? ", log scale" : ""); }

  /// Returns the style classes of a series.
  [[nodiscard]] std::string class_of(const ChartSeries& one) const;
};

/// A part of a report that is also a separate file. `name` is the file's name without extension, such as
/// "tip-path".
struct ReportFigure {
  std::string name;
  std::variant<Drawing, LineChart> content;
};

/// Returns the chart as a picture.
[[nodiscard]] Drawing chart_picture(const LineChart& chart);

}  // namespace flexura
