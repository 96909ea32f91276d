#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// A data interval, low <= high.
struct Interval {
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] double extent() const { return high - low; }
  void include(double value);
};

inline constexpr double heading_space = 34.0;  ///< Above a plot, for its heading.
inline constexpr double tallest_plot = 430.0;

/// Returns the range grown about its middle to an extent of at least `extent`.
[[nodiscard]] Interval grown_to(Interval range, double extent);

/// Returns the range grown about its middle to an extent of at least `least`, and then by `margin` of the
/// extent at each end. An extent below the resolution of its numbers counts as zero, so the result's extent
/// is > 0.
[[nodiscard]] Interval padded(Interval range, double least, double margin);

/// Ticks of an axis.
struct Ticks {
  std::vector<double> values;  ///< Increasing multiples of 1, 2 or 5 times a power of ten, inside the range.
  std::vector<std::string> labels;  ///< One per value, all with equal numbers of decimals.
};

/// Returns at most `most` (>= 2) ticks for a range of positive extent, and as many as the steps allow.
[[nodiscard]] Ticks nice_ticks(Interval range, int most);

/// Returns ticks for a range of powers of ten, whose labels are the numbers: "0.01". Whole powers if the
/// range has two.
[[nodiscard]] Ticks power_ticks(Interval range, int most);

/// Position of a plot on the page and its range. Data's y goes up unless y_down is set; the page's goes down.
struct PlotFrame {
  Interval x;
  Interval y;
  Eigen::Vector2d corner;  ///< Top left, page units.
  Eigen::Vector2d size;    ///< Page units.
  bool y_down = false;     ///< Data's y goes down.
  bool y_log = false;      ///< Data's y are powers of ten; the axis has the numbers themselves.

  [[nodiscard]] Eigen::Vector2d scale() const { return {size.x() / x.extent(), size.y() / y.extent()}; }
  /// Returns the page point of a data point.
  [[nodiscard]] Eigen::Vector2d page(const Eigen::Vector2d& data) const;
  [[nodiscard]] double bottom() const { return corner.y() + size.y(); }
  [[nodiscard]] double right() const { return corner.x() + size.x(); }
};

/// Height below the plot of the axes from draw_axes, page units.
inline constexpr double space_below_axes = 44.0;

/// Returns their width to the left of a plot with a height of `height` page units that shows `y`. `y_log`: as
/// in PlotFrame.
[[nodiscard]] double left_of_axes(Interval y, double height, bool y_log = false);

/// Draws the plot's border, grid, ticks and the names of its axes.
void draw_axes(XmlWriter& svg, const PlotFrame& frame, std::string_view x_name, std::string_view y_name);

/// Opens a picture within the picture that clips at the plot's border; close() closes it.
void open_inside(XmlWriter& svg, const PlotFrame& frame);

/// Returns the style classes of line `index`: its colour and its dash. Of 32 lines, no two are equal.
[[nodiscard]] std::string line_class(std::size_t index);

/// A line's name and style classes.
struct LegendEntry {
  std::string name;
  std::string css_class;
};

/// Draws a legend in rows from the page point `corner` (top left), no further right than `right`: a title,
/// possibly empty, then the items. Returns its height, page units.
double draw_legend(XmlWriter& svg, const std::string& title, const std::vector<LegendEntry>& entries,
                   const Eigen::Vector2d& corner, double right);

}  // namespace flexura
