#include "flexura/report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flexura/report/axes.h"

namespace flexura {
namespace {

constexpr double chart_width = 520.0;
constexpr double heading_space = 34.0;
constexpr double right_space = 18.0;
constexpr double chart_plot_height = 216.0;
constexpr double legend_row = 22.0;
constexpr double swatch_width = 20.0;
constexpr double dash_length = 11.0;  // Of each of several lines on top of each other.

double text_width(std::string_view text) { return 7.8 * static_cast<double>(text.size()); }

// Draws the legend in rows below the plot and returns their height.
double draw_legend(XmlWriter& svg, const LineChart& chart, double left, double top) {
  if (chart.series.size() < 2 && chart.legend.empty()) return 0.0;
  double x = left;
  double y = top + 16.0;
  if (!chart.legend.empty()) {
    svg.label({x, y}, "tick", chart.legend);
    x += text_width(chart.legend) + 10.0;
  }
  const double indent = x;
  for (const ChartSeries& series : chart.series) {
    const double width = swatch_width + 6.0 + text_width(series.name) + 10.0;
    if (x + width > chart_width - 4.0) {
      x = indent;
      y += legend_row;
    }
    svg.leaf(
        "path",
        {{"class", "line " + series.css_class},
         {"d", fmt::format("M{} {}h{}", page_number(x), page_number(y - 5.0), page_number(swatch_width))}});
    svg.label({x + swatch_width + 6.0, y}, "", series.name);
    x += width;
  }
  return y + 10.0 - top;
}

void draw_events(XmlWriter& svg, const PlotFrame& frame, const std::vector<double>& event_times) {
  std::string path;
  for (const double time : event_times) {
    path += fmt::format("M{} {}V{}", page_number(frame.page({time, 0.0}).x()), page_number(frame.corner.y()),
                        page_number(frame.bottom()));
  }
  if (!path.empty()) svg.leaf("path", {{"class", "event"}, {"d", path}});
}

// A line's place among those that run on top of each other.
struct Share {
  std::size_t rank = 0;
  std::size_t of = 1;
};

std::vector<Share> shares_of(const std::vector<ChartSeries>& series, double tolerance) {
  const auto coincide = [&](const ChartSeries& a, const ChartSeries& b) {
    return std::ranges::equal(a.values, b.values,
                              [&](double u, double v) { return std::abs(u - v) <= tolerance; });
  };
  std::vector<Share> shares;
  for (const ChartSeries& one : series) {
    const auto mine = std::ranges::find_if(series, [&](const ChartSeries& other) { return &other == &one; });
    const auto same = [&](const ChartSeries& other) { return coincide(one, other); };
    shares.push_back({static_cast<std::size_t>(std::count_if(series.begin(), mine, same)),
                      static_cast<std::size_t>(std::ranges::count_if(series, same))});
  }
  return shares;
}

void draw_series(XmlWriter& svg, const PlotFrame& frame, const ChartSeries& series,
                 const std::vector<double>& times, const Share& share) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) points.push_back(frame.page({times[i], series.values[i]}));
  if (points.size() == 1) {
    svg.leaf("circle", {{"class", "dot " + series.css_class},
                        {"cx", page_number(points[0].x())},
                        {"cy", page_number(points[0].y())},
                        {"r", "4"}});
    return;
  }
  const std::string path = polyline_path(simplified(points, 0.05));
  if (share.of == 1) {
    svg.leaf("path", {{"class", "line " + series.css_class}, {"d", path}});
    return;
  }
  // Lines on top of each other take turns, so that all can be seen.
  svg.leaf("path",
           {{"class", "line shared " + series.css_class},
            {"stroke-dasharray",
             fmt::format("{} {}", dash_length, page_number(dash_length * static_cast<double>(share.of - 1)))},
            {"stroke-dashoffset", page_number(-dash_length * static_cast<double>(share.rank))},
            {"d", path}});
}

}  // namespace

Drawing chart_picture(const LineChart& chart, const std::vector<double>& times,
                      const std::vector<double>& event_times) {
  Interval values = {chart.series.front().values.front(), chart.series.front().values.front()};
  for (const ChartSeries& series : chart.series) {
    for (const double value : series.values) values.include(value);
  }
  values = padded(values, chart.least, 0.05);
  const double left = left_of_axes(values, chart_plot_height);
  const Interval time_range = times.back() > times.front() ? padded({times.front(), times.back()}, 0.0, 0.0)
                                                           : padded({times.front(), times.front()}, 1.0, 0.0);
  const PlotFrame frame = {
      time_range, values, {left, heading_space}, {chart_width - left - right_space, chart_plot_height}};

  XmlWriter svg;
  std::string names;
  for (const ChartSeries& series : chart.series) names += (names.empty() ? "" : " ") + series.name;
  svg.open("g", {{"class", "chart"},
                 {"data-chart", chart.name},
                 {"data-series", names},
                 {"data-left", page_number(frame.corner.x())},
                 {"data-right", page_number(frame.right())},
                 {"data-top", page_number(frame.corner.y())},
                 {"data-bottom", page_number(frame.bottom())},
                 {"data-from", fmt::format("{:.9g}", time_range.low)},
                 {"data-to", fmt::format("{:.9g}", time_range.high)}});
  svg.label({left, 22.0}, "heading", chart.heading);
  draw_axes(svg, frame, "t (s)", chart.value_label);
  draw_events(svg, frame, event_times);
  const std::vector<Share> shares = shares_of(chart.series, 0.5 / frame.scale().y());
  for (std::size_t i = 0; i < shares.size(); ++i) draw_series(svg, frame, chart.series[i], times, shares[i]);
  const double below = frame.bottom() + space_below_axes;
  const double height = below + draw_legend(svg, chart, left, below);
  return {chart_width, height, fmt::format("Chart over time: {}, {}", chart.heading, chart.value_label),
          svg.text()};
}

}  // namespace flexura
