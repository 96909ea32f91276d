#include "flexura/report/scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace flexura {
namespace {

constexpr double space_for_label = 16.0;  // Also right of a plot, for half a tick label.
constexpr double one_view_width = 440.0;  // Width of a picture.
constexpr double two_views_width = 600.0;
constexpr double flattest_plot = 0.6;  // Height over width of a plot.
constexpr double margin_part = 0.06;

Interval range_along(const Eigen::AlignedBox3d& box, int axis) { return {box.min()[axis], box.max()[axis]}; }

}  // namespace

PlotScene scene_of(const Eigen::AlignedBox3d& box, bool one_view, double least) {
  PlotScene scene;
  scene.views = one_view ? std::vector{PlotView::xoy} : std::vector{PlotView::xoy, PlotView::zoy};
  const auto plots = static_cast<double>(scene.views.size());
  scene.width = one_view ? one_view_width : two_views_width;

  std::vector<Interval> across;
  double widest = 0.0;
  for (const PlotView view : scene.views) {
    across.push_back(padded(range_along(box, view == PlotView::xoy ? 0 : 2), least, margin_part));
    widest = std::max(widest, across.back().extent());
  }
  Interval up = padded(range_along(box, 1), least, margin_part);
  // The room for tick labels depends on the plot's height, and the height on that room; the largest height is
  // a good approximation.
  const double left = left_of_axes(up, tallest_plot);
  const double plot_width = scene.width / plots - left - space_for_label;
  widest = std::max(widest, up.extent() * plot_width / tallest_plot);
  up = grown_to(up, flattest_plot * widest);
  const double plot_height = plot_width * up.extent() / widest;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const double x = scene.width / plots * static_cast<double>(i) + left;
    scene.frames.push_back({grown_to(across[i], widest), up, {x, heading_space}, {plot_width, plot_height}});
  }
  scene.height = heading_space + plot_height + space_below_axes;
  return scene;
}

void extend_by_tube(Eigen::AlignedBox3d& box, const Backbone& backbone) {
  constexpr double step = 0.2;  // In rad; an arc bulges at most step^2/8 of its radius between points.
  for (const Arc& arc : backbone.arcs()) {
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(std::max(arc.radius[0], arc.radius[1]));
    // After a full turn it repeats itself.
    const double bend = arc.bend.norm(), turn = std::min(bend, 2 * std::numbers::pi);
    const double reach = bend > 0 ? arc.length * turn / bend : arc.length;
    const double steps = 1.0 + std::floor(turn / step);
    for (double k = 0.0; k <= steps; ++k) {
      const Eigen::Vector3d at = arc.pose(reach * k / steps).position;
      box.extend(Eigen::AlignedBox3d(at - around, at + around));
    }
  }
}

Eigen::AlignedBox3d swept_box(const ReportMotion& motion) {
  Eigen::AlignedBox3d box;
  for (const Backbone& backbone : motion.backbones) extend_by_tube(box, backbone);
  return box;
}

Eigen::AlignedBox3d with_targets(Eigen::AlignedBox3d box, const ReportMotion& motion) {
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(0.5 * box.diagonal().norm());
  const Eigen::AlignedBox3d near(box.min() - around, box.max() + around);
  for (const auto& violation : motion.violations) {
    if (violation.target) box.extend(violation.target->cwiseMax(near.min()).cwiseMin(near.max()));
  }
  return box;
}

void draw_scene_axes(XmlWriter& svg, const PlotScene& scene, std::string_view heading) {
  const Eigen::Vector2d& first = scene.frames.front().corner;
  svg.label({first.x(), 22.0}, "heading", heading);
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    draw_axes(svg, scene.frames[i], scene.views[i] == PlotView::xoy ? "X (m)" : "Z (m)", "Y (m)");
  }
}

void label_beside(XmlWriter& svg, const PlotFrame& frame, const Eigen::Vector2d& at,
                  std::string_view content) {
  const bool is_left = at.x() < frame.corner.x() + frame.size.x() / 2;
  svg.label({at.x() + (is_left ? 11.0 : -11.0), at.y() + 5.0}, is_left ? "halo" : "halo end", content);
}

}  // namespace flexura
