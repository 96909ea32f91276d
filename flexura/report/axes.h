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

inline constexpr double heading_space = 34.0;  ///< Space above a plot for its heading, page units.
inline constexpr double tallest_plot = 430.0;  ///< Largest height of a plot, page units.

/// Returns `range`, enlarged about its middle to an extent of at least `extent`.
[[nodiscard]] Interval grown_to(Interval range, double extent);

/// Returns `range`, enlarged about its middle to an extent of at least `least`, and then at each end by the
/// share `margin` of this extent. The result's extent is > 0. An extent below the resolution of the range's
/// numbers counts as zero.
[[nodiscard]] Interval padded(Interval range, double least, double margin);

/// Ticks of an axis.
struct Ticks {
  std::vector<double> values;  ///< Increasing multiples of 1, 2 or 5 times a power of ten, inside the range.
  std::vector<std::string>
      labels;  ///< Labels of the values, one per value, all with the same number of decimals.
};

/// Returns ticks for a range of positive extent: at most `most` (>= 2), and as many as possible.
[[nodiscard]] Ticks nice_ticks(Interval range, int most);

/// Returns ticks for a range of exponents of ten, whose labels are the powers: "0.01". The ticks are at whole
/// exponents if the range contains at least two of them.
[[nodiscard]] Ticks power_ticks(Interval range, int most);

/// Position of a plot on the page and its range of data. The y of data increases upwards unless `y_down` is
/// set. The y of the page increases downwards.
struct PlotFrame {
  Interval x;
  Interval y;
  Eigen::Vector2d corner;  ///< Top left corner of the plot, page units.
  Eigen::Vector2d size;    ///< Width and height of the plot, page units.
  bool y_down = false;     ///< Whether the y of data increases downwards.
  bool y_log = false;  ///< Whether the y of data are exponents of ten, so that the axis shows powers of ten.

  [[nodiscard]] Eigen::Vector2d scale() const { return {size.x() / x.extent(), size.y() / y.extent()}; }
  /// Returns the page point of a data point.
  [[nodiscard]] Eigen::Vector2d page(const Eigen::Vector2d& data) const;
  [[nodiscard]] double bottom() const { return corner.y() + size.y(); }
  [[nodiscard]] double right() const { return corner.x() + size.x(); }
};

/// Height of the axis below a plot, drawn by draw_axes(), page units.
inline constexpr double space_below_axes = 44.0;

/// Returns the width of the axis to the left of a plot, page units. `height`: height of the plot, page units.
/// `y`: range of the plot's data. `y_log`: PlotFrame::y_log.
[[nodiscard]] double left_of_axes(Interval y, double height, bool y_log = false);

/// Draws the plot's border, grid, ticks and the names of its axes.
void draw_axes(XmlWriter& svg, const PlotFrame& frame, std::string_view x_name, std::string_view y_name);

/// Opens an inner SVG element that is clipped at the plot's border; XmlWriter::close() closes it.
void open_inside(XmlWriter& svg, const PlotFrame& frame);

/// Returns the style classes of line `index`: its colour and its dash. The first 32 lines have different
/// styles.
[[nodiscard]] std::string line_class(std::size_t index);

/// A line's name and style classes.
struct LegendEntry {
  std::string name;
  std::string css_class;
};

/// Draws a legend in rows from the page point `corner` (top left), and not beyond `right`. The legend
/// consists of a title, which may be empty, and the entries. Returns the legend's height, page units.
double draw_legend(XmlWriter& svg, const std::string& title, const std::vector<LegendEntry>& entries,
                   const Eigen::Vector2d& corner, double right);

}  // namespace flexura
