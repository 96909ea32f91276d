#include "flexura/report/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexura {
namespace {

// Least distance of ticks, page units, so that labels do not overlap.
constexpr double tick_pitch_x = 56.0;
constexpr double tick_pitch_y = 34.0;
constexpr double tick_character_width = 7.2;

int most_ticks(double size, double pitch) { return std::clamp(static_cast<int>(size / pitch), 2, 10); }

int power_of_ten(double value) { return static_cast<int>(std::floor(std::log10(value) + 1e-9)); }

std::string tick_label(double value, double step, double largest) {
  if (step < 1e-4 || largest >= 1e6) {
    const int decimals = std::clamp(power_of_ten(largest) - power_of_ten(step), 0, 15);
    return value == 0.0 ? "0" : fmt::format("{:.{}e}", value, decimals);
  }
  return fixed(value, std::max(0, -power_of_ten(step)));
}

Ticks value_ticks(Interval range, int most, bool is_log) {
  return is_log ? power_ticks(range, most) : nice_ticks(range, most);
}

}  // namespace

Interval grown_to(Interval range, double extent) {
  const double more = std::max(0.0, extent - range.extent()) / 2;
  return {range.low - more, range.high + more};
}

void Interval::include(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

Interval padded(Interval range, double least, double margin) {
  const double noise =
      64 * std::numeric_limits<double>::epsilon() * std::max(std::abs(range.low), std::abs(range.high));
  const double desired = std::max({least, 1e3 * noise, 1e-9});
  if (range.extent() < desired) {
    const double middle = range.low + range.extent() / 2;
    range = {middle - desired / 2, middle + desired / 2};
  }
  const double border = margin * range.extent();
  return {range.low - border, range.high + border};
}

Ticks nice_ticks(Interval range, int most) {
  const double slack = 1e-9;
  double step = 0.0;
  double first = 0.0;
  double last = 0.0;
  // Starts with a power of ten that is too small, then increases until few enough ticks are left.
  const int power = static_cast<int>(std::floor(std::log10(range.extent() / most))) - 1;
  for (int i = 0;; ++i) {
    const double factors[] = {1.0, 2.0, 5.0};
    const int exponent = power + i / 3;
    // Division makes 0.1, 0.2, ... the numbers nearest to their labels.
    const double ten = std::pow(10.0, std::abs(exponent));
    step = exponent < 0 ? factors[i % 3] / ten : factors[i % 3] * ten;
    first = std::ceil(range.low / step - slack);
    last = std::floor(range.high / step + slack);
    if (last - first < most) break;
  }
  Ticks ticks;
  const double largest = std::max(std::abs(first), std::abs(last)) * step;
  for (double i = first; i <= last; ++i) {
    ticks.values.push_back(std::clamp(i * step, range.low, range.high) + 0.0);
    ticks.labels.push_back(tick_label(i * step, step, std::max(largest, step)));
  }
  return ticks;
}

Ticks power_ticks(Interval range, int most) {
  const int whole = static_cast<int>(std::floor(range.extent()));
  Ticks ticks = nice_ticks(range, whole < 2 ? most : std::min(most, whole + 1));
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double power = ticks.values[i];
    ticks.labels[i] = fmt::format("{:.2g}", std::pow(10.0, power));
    if (power == std::round(power) && power >= 0 && power < 5)
      ticks.labels[i] = fmt::format("{:.0f}", std::pow(10.0, power));
  }
  return ticks;
}

Eigen::Vector2d PlotFrame::page(const Eigen::Vector2d& data) const {
  const double along = (data.y() - y.low) * scale().y();
  return {corner.x() + (data.x() - x.low) * scale().x(), y_down ? corner.y() + along : bottom() - along};
}

double left_of_axes(Interval y, double height, bool y_log) {
  std::size_t longest = 1;
  for (const std::string& label : value_ticks(y, most_ticks(height, tick_pitch_y), y_log).labels) {
    longest = std::max(longest, label.size());
  }
  return 32.0 + tick_character_width * static_cast<double>(longest);
}

void draw_axes(XmlWriter& svg, const PlotFrame& frame, std::string_view x_name, std::string_view y_name) {
  const Ticks x_ticks = nice_ticks(frame.x, most_ticks(frame.size.x(), tick_pitch_x));
  const Ticks y_ticks = value_ticks(frame.y, most_ticks(frame.size.y(), tick_pitch_y), frame.y_log);
  std::string grid;
  for (const double value : x_ticks.values) {
    const double x = frame.page({value, frame.y.low}).x();
    grid +=
        fmt::format("M{} {}V{}", page_number(x), page_number(frame.corner.y()), page_number(frame.bottom()));
  }
  for (const double value : y_ticks.values) {
    const double y = frame.page({frame.x.low, value}).y();
    grid +=
        fmt::format("M{} {}H{}", page_number(frame.corner.x()), page_number(y), page_number(frame.right()));
  }
  svg.leaf("path", {{"class", "grid"}, {"d", grid}});
  svg.rect(frame.corner, frame.size, "plot");
  for (std::size_t i = 0; i < x_ticks.values.size(); ++i) {
    const double x = frame.page({x_ticks.values[i], frame.y.low}).x();
    svg.label({x, frame.bottom() + 17}, "tick middle", x_ticks.labels[i]);
  }
  for (std::size_t i = 0; i < y_ticks.values.size(); ++i) {
    const double y = frame.page({frame.x.low, y_ticks.values[i]}).y();
    svg.label({frame.corner.x() - 7, y + 4.5}, "tick end", y_ticks.labels[i]);
  }
  svg.label({frame.corner.x() + frame.size.x() / 2, frame.bottom() + 37}, "middle", x_name);
  const Eigen::Vector2d side = {frame.corner.x() - left_of_axes(frame.y, frame.size.y(), frame.y_log) + 15,
                                frame.corner.y() + frame.size.y() / 2};
  svg.leaf("text",
           {{"class", "middle"}, {"transform", fmt::format("translate({}) rotate(-90)", page_point(side))}},
           y_name);
}

void open_inside(XmlWriter& svg, const PlotFrame& frame) {
  svg.open("svg", {{"x", page_number(frame.corner.x())},
                   {"y", page_number(frame.corner.y())},
                   {"width", page_number(frame.size.x())},
                   {"height", page_number(frame.size.y())},
                   {"viewBox", page_point(frame.corner) + ' ' + page_point(frame.size)}});
}

std::string line_class(std::size_t index) {
  // At most one solid line, below the others: gaps in the others keep coincident lines visible.
  const std::size_t color = index % 8, dash = color == 0 ? 0 : 1 + (color - 1) % 3;
  return fmt::format("s{} dash{}", color, (dash + index / 8) % 4);
}

double draw_legend(XmlWriter& svg, const std::string& title, const std::vector<LegendEntry>& entries,
                   const Eigen::Vector2d& corner, double right) {
  constexpr double row_height = 22.0, swatch_width = 34.0;
  const auto text_width = [](const std::string& text) { return 7.8 * static_cast<double>(text.size()); };
  double x = corner.x();
  double y = corner.y() + 16.0;
  if (!title.empty()) {
    svg.label({x, y}, "tick", title);
    x += text_width(title) + 10.0;
  }
  const double indent = x;
  for (const LegendEntry& entry : entries) {
    const double width = swatch_width + 6.0 + text_width(entry.name) + 10.0;
    if (x + width > right) {
      x = indent;
      y += row_height;
    }
    svg.leaf("path", {{"class", "line " + entry.css_class},
                      {"d", polyline_path({{x, y - 5.0}, {x + swatch_width, y - 5.0}})}});
    svg.label({x + swatch_width + 6.0, y}, "", entry.name);
    x += width;
  }
  return y + 10.0 - corner.y();
}

}  // namespace flexura
