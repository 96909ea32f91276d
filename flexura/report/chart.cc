#include "flexura/report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "flexura/report/axes.h"
#include "flexura/report/legend.h"

namespace flexura {
namespace {

constexpr double chart_width = 520.0;
constexpr double right_space = 18.0;
constexpr double chart_plot_height = 216.0;
constexpr double dash_length = 11.0;  // Of each of several lines on top of each other.

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
    return std::ranges::equal(a.values, b.values, [&](double u, double v) {
      return (std::isnan(u) && std::isnan(v)) || std::abs(u - v) <= tolerance;
    });
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

// The points of the values that are numbers, those between two others that are not apart.
std::vector<std::vector<Eigen::Vector2d>> runs_of(const PlotFrame& frame, const std::vector<double>& times,
                                                  const std::vector<double>& values) {
  std::vector<std::vector<Eigen::Vector2d>> runs(1);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isfinite(values[i])) {
      runs.back().push_back(frame.page({times[i], values[i]}));
    } else if (!runs.back().empty()) {
      runs.emplace_back();
    }
  }
  if (runs.back().empty()) runs.pop_back();
  return runs;
}

void draw_dot(XmlWriter& svg, const std::string& css_class, const Eigen::Vector2d& at, const char* radius) {
  svg.leaf("circle", {{"class", "dot " + css_class},
                      {"cx", page_number(at.x())},
                      {"cy", page_number(at.y())},
                      {"r", radius}});
}

void draw_cross(XmlWriter& svg, const std::string& css_class, const Eigen::Vector2d& at) {
  constexpr double half = 4;
  const auto stroke = [&](double rise) {
    return fmt::format("M{} {}L{} {}", page_number(at.x() - half), page_number(at.y() - rise),
                       page_number(at.x() + half), page_number(at.y() + rise));
  };
  svg.leaf("path", {{"class", "line " + css_class}, {"d", stroke(half) + stroke(-half)}});
}

void draw_series(XmlWriter& svg, const PlotFrame& frame, const ChartSeries& series,
                 const std::vector<double>& times, const Share& share) {
  std::string path;
  for (const std::vector<Eigen::Vector2d>& run : runs_of(frame, times, series.values)) {
    if (run.size() == 1) {
      draw_dot(svg, series.css_class, run[0], "4");
    } else {
      path += polyline_path(simplified(run, 0.05));
    }
  }
  for (std::size_t i = 0; i < series.dots.size(); ++i) {
    if (std::isfinite(series.dots[i]))
      draw_dot(svg, series.css_class, frame.page({times[i], series.dots[i]}), "3");
  }
  for (std::size_t i = 0; i < series.crosses.size(); ++i)
    if (std::isfinite(series.crosses[i]))
      draw_cross(svg, series.css_class, frame.page({times[i], series.crosses[i]}));
  if (path.empty()) return;
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

// What the values reach over; nothing at 0 where none is a number.
Interval range_of(const std::vector<ChartSeries>& series) {
  std::optional<Interval> range;
  const auto include = [&](const std::vector<double>& values) {
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      if (!range) range = {value, value};
      range->include(value);
    }
  };
  for (const ChartSeries& one : series) {
    include(one.values);
    include(one.dots);
    include(one.crosses);
  }
  return range.value_or(Interval{});
}

// Opens the group that the chart is in, and tells the page's script where it is.
void open_group(XmlWriter& svg, const LineChart& chart, const PlotFrame& frame) {
  if (!chart.is_over_time()) {
    svg.open("g");
    return;
  }
  std::string names;
  for (const ChartSeries& series : chart.series) names += (names.empty() ? "" : " ") + series.name;
  svg.open("g", {{"class", "chart"},
                 {"data-chart", chart.name},
                 {"data-series", names},
                 {"data-left", page_number(frame.corner.x())},
                 {"data-right", page_number(frame.right())},
                 {"data-top", page_number(frame.corner.y())},
                 {"data-bottom", page_number(frame.bottom())},
                 {"data-from", fmt::format("{:.9g}", frame.x.low)},
                 {"data-to", fmt::format("{:.9g}", frame.x.high)}});
}

}  // namespace

Drawing chart_picture(const LineChart& chart, const std::vector<double>& times,
                      const std::vector<double>& event_times) {
  const Interval values = padded(range_of(chart.series), chart.least, 0.05);
  const double left = left_of_axes(values, chart_plot_height);
  const Interval time_range = times.back() > times.front() ? padded({times.front(), times.back()}, 0.0, 0.0)
                                                           : padded({times.front(), times.front()}, 1.0, 0.0);
  const PlotFrame frame = {
      time_range, values, {left, heading_space}, {chart_width - left - right_space, chart_plot_height}};

  XmlWriter svg;
  open_group(svg, chart, frame);
  svg.label({left, 22.0}, "heading", chart.heading);
  draw_axes(svg, frame, chart.is_over_time() ? "t (s)" : chart.x_label, chart.value_label);
  draw_events(svg, frame, event_times);
  const std::vector<Share> shares = shares_of(chart.series, 0.5 / frame.scale().y());
  for (std::size_t i = 0; i < shares.size(); ++i) draw_series(svg, frame, chart.series[i], times, shares[i]);
  const double below = frame.bottom() + space_below_axes;
  double height = below;
  if (chart.series.size() > 1 || !chart.legend.empty()) {
    std::vector<LegendEntry> entries;
    entries.reserve(chart.series.size());
    for (const ChartSeries& one : chart.series) entries.push_back({one.name, one.css_class});
    height += draw_legend(svg, chart.legend, entries, {left, below}, chart_width - 4.0);
  }
  return {chart_width, height,
          fmt::format("Chart over {}: {}, {}", chart.is_over_time() ? "time" : chart.x_label, chart.heading,
                      chart.value_label),
          svg.text()};
}

}  // namespace flexura
