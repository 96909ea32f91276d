#include "flexura/report/image_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "flexura/report/axes.h"

namespace flexura {
namespace {

constexpr double picture_width = 520.0;
constexpr double space_right_of_picture = 18.0;
constexpr double flattest_picture = 0.4;  // Height over width.

// Returns the range of the outlines in the image along one axis; the whole image if they are outside.
Interval shown_along(const ImagePlot& plot, int axis) {
  const Interval all = {-0.5, (axis == 0 ? plot.width : plot.height) - 0.5};
  if (!plot.background.empty()) return all;
  Interval range = {all.high, all.low};
  for (const ImageOutline& outline : plot.outlines) {
    for (const ImageOutline::Line& line : outline.lines) {
      for (const Eigen::Vector2d& point : line.points) {
        const double at = std::clamp(point[axis], all.low, all.high);
        range = {std::min(range.low, at), std::max(range.high, at)};
      }
    }
  }
  return range.low <= range.high ? range : all;
}

PlotFrame frame_of(const ImagePlot& plot) {
  const double margin = plot.background.empty() ? 0.05 : 0;
  Interval x = padded(shown_along(plot, 0), 1, margin);
  Interval y = padded(shown_along(plot, 1), 1, margin);
  const double left = left_of_axes(y, tallest_plot);
  const double width = picture_width - left - space_right_of_picture;
  x = grown_to(x, y.extent() * width / tallest_plot);
  y = grown_to(y, flattest_picture * x.extent());
  return {x, y, {left, heading_space}, {width, width * y.extent() / x.extent()}, true};
}

// Draws the image itself, if given, and its border.
void draw_image(XmlWriter& svg, const ImagePlot& plot, const PlotFrame& frame) {
  const Eigen::Vector2d corner = frame.page({-0.5, -0.5});
  const Eigen::Vector2d size = frame.scale().cwiseProduct(Eigen::Vector2d(plot.width, plot.height));
  if (!plot.background.empty()) {
    svg.leaf("image", {{"href", plot.background},
                       {"x", page_number(corner.x())},
                       {"y", page_number(corner.y())},
                       {"width", page_number(size.x())},
                       {"height", page_number(size.y())}});
  }
  svg.rect(corner, size, "plot");
}

void draw_outline(XmlWriter& svg, const PlotFrame& frame, const ImageOutline& outline) {
  for (const ImageOutline::Line& line : outline.lines) {
    std::vector<Eigen::Vector2d> points;
    points.reserve(line.points.size());
    for (const Eigen::Vector2d& point : line.points) points.push_back(frame.page(point));
    if (points.empty()) continue;
    svg.leaf("path", {{"class", fmt::format("line {} {}", outline.css_class, line.css_class)},
                      {"d", polyline_path(simplified(points, 0.05))}});
  }
}

}  // namespace

Drawing image_picture(const ImagePlot& plot) {
  const PlotFrame frame = frame_of(plot);
  XmlWriter svg;
  svg.label({frame.corner.x(), 22.0}, "heading", plot.heading);
  draw_axes(svg, frame, "column (px)", "row (px)");
  open_inside(svg, frame);
  draw_image(svg, plot, frame);
  for (const ImageOutline& outline : plot.outlines) draw_outline(svg, frame, outline);
  svg.close();
  std::vector<LegendEntry> entries;
  entries.reserve(plot.outlines.size());
  for (const ImageOutline& outline : plot.outlines) entries.push_back({outline.name, outline.css_class});
  const double below = frame.bottom() + space_below_axes;
  const double legend =
      draw_legend(svg, plot.legend, entries, {frame.corner.x(), below}, picture_width - 4.0);
  return {picture_width, below + legend, "Image: " + plot.heading, svg.text()};
}

}  // namespace flexura
