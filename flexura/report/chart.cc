#include "flexura/report/chart.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "flexura/report/axes.h"

namespace flexura {
namespace {

constexpr double chart_width = 520.0;
constexpr double right_space = 18.0;
constexpr double chart_plot_height = 216.0;

bool is_number(const std::vector<double>& values, std::size_t i) {
  return i < values.size() && std::isfinite(values[i]);
}

void draw_series(XmlWriter& svg, const PlotFrame& frame, const std::vector<double>& x,
                 const ChartSeries& series, const std::string& css_class) {
  std::string path;
  std::vector<Eigen::Vector2d> run;  // Consecutive finite values.
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto at = [&](const std::vector<double>& values) { return frame.page({x[i], values[i]}); };
    if (is_number(series.values, i)) run.push_back(at(series.values));
    if (!is_number(series.values, i + 1) && !run.empty()) {
      if (run.size() == 1) svg.circle(run[0], "dot " + css_class, 4);
      if (run.size() > 1) path += polyline_path(simplified(run, 0.05));
      run.clear();
    }
    if (is_number(series.dots, i)) svg.circle(at(series.dots), "dot " + css_class, 3);
    if (is_number(series.rings, i)) svg.circle(at(series.rings), "ring " + css_class, 4.5);
  }
  if (!path.empty()) svg.leaf("path", {{"class", "line " + css_class}, {"d", path}});
}

// Returns the range of the values; 0 to 0 if none is finite.
Interval range_of(const std::vector<ChartSeries>& series) {
  std::optional<Interval> range;
  for (const ChartSeries& one : series) {
    for (const auto* values : {&one.values, &one.dots, &one.rings}) {
      for (const double value : *values) {
        if (!std::isfinite(value)) continue;
        if (!range) range = {value, value};
        range->include(value);
      }
    }
  }
  return range.value_or(Interval{});
}

}  // namespace

std::string LineChart::class_of(const ChartSeries& one) const {
  return one.css_class.empty() ? line_class(static_cast<std::size_t>(&one - series.data())) : one.css_class;
}

Drawing chart_picture(const LineChart& chart) {
  const Interval values = padded(range_of(chart.series), chart.least, 0.05);
  const double left = left_of_axes(values, chart_plot_height, chart.is_log);
  const Interval across = {chart.x.front(), chart.x.back()};
  const PlotFrame frame = {
      padded(across, across.extent() > 0 ? 0.0 : 1.0, 0.0),  values, {left, heading_space},
      {chart_width - left - right_space, chart_plot_height}, false,  chart.is_log};
  XmlWriter svg;
  svg.label({left, 22.0}, "heading", chart.heading);
  draw_axes(svg, frame, chart.x_label, chart.axis_label());
  std::string marks;
  for (const double mark : chart.marks)
    marks += polyline_path({frame.page({mark, values.low}), frame.page({mark, values.high})});
  if (!marks.empty()) svg.leaf("path", {{"class", "event"}, {"d", marks}});
  std::vector<LegendEntry> entries;
  for (const ChartSeries& one : chart.series) {
    draw_series(svg, frame, chart.x, one, chart.class_of(one));
    entries.push_back({one.name, chart.class_of(one)});
  }
  double height = frame.bottom() + space_below_axes;
  if (entries.size() > 1 || !chart.legend.empty())
    height += draw_legend(svg, chart.legend, entries, {left, height}, chart_width - 4.0);
  return {chart_width, height,
          fmt::format("Chart over {}: {}, {}", chart.x_label, chart.heading, chart.axis_label()), svg.text()};
}

}  // namespace flexura
