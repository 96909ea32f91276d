#include "flexura/report/scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace flexura {
namespace {

constexpr double space_for_label = 16.0;  // And right of a plot, for half a tick label.
constexpr double one_view_width = 440.0;  // Width of a picture.
constexpr double two_views_width = 600.0;
constexpr double flattest_plot = 0.6;  // Height over width of a plot.
constexpr double margin_part = 0.06;

Interval range_along(const Eigen::AlignedBox3d& box, int axis) { return {box.min()[axis], box.max()[axis]}; }

Eigen::AlignedBox2d text_box(const Eigen::Vector2d& corner, std::string_view content) {
  const Eigen::Vector2d size = {7.6 * static_cast<double>(content.size()), 17.0};
  return {corner, corner + size};
}

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
  // The room for tick labels depends on the plot's height and the height on that room; the tallest is a fair
  // guess.
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

Eigen::AlignedBox3d swept_box(const ReportMotion& motion) {
  constexpr double step = 0.2;  // rad; an arc bulges at most step^2/8 of its radius between points.
  Eigen::AlignedBox3d box;
  for (const Backbone& backbone : motion.backbones) {
    for (std::size_t i = 0; i < backbone.arcs().size(); ++i) {
      const Arc& arc = backbone.arcs()[i];
      const std::array<double, 2>& radius = motion.arm.sections[i].radius;
      const Eigen::Vector3d around = Eigen::Vector3d::Constant(std::max(radius[0], radius[1]));
      const double steps = 1.0 + std::floor(arc.bend.norm() / step);
      for (double k = 0.0; k <= steps; ++k) {
        const Eigen::Vector3d at = arc.pose(arc.length * k / steps).position;
        box.extend(Eigen::AlignedBox3d(at - around, at + around));
      }
    }
  }
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

double LabelPlacer::cost(const Eigen::AlignedBox2d& box) const {
  const Eigen::AlignedBox2d plot(frame_.corner, frame_.corner + frame_.size);
  const Eigen::Vector2d border = {4.0, 3.0};
  double cost = plot.contains(Eigen::AlignedBox2d(box.min() - border, box.max() + border)) ? 0.0 : 1e6;
  for (const Taken& taken : taken_) {
    const double distance = box.exteriorDistance(taken.point);
    cost += distance <= 0.0 ? taken.weight : std::max(0.0, 1.0 - distance / 8.0);
  }
  return cost;
}

void LabelPlacer::place(XmlWriter& svg, const Eigen::Vector2d& at, std::string_view content) {
  const Eigen::Vector2d size = text_box({0.0, 0.0}, content).sizes();
  Eigen::AlignedBox2d best;
  double least = std::numeric_limits<double>::infinity();
  for (const double away : {12.0, 22.0, 36.0, 54.0, 80.0}) {
    for (const double side : {0.0, 1.0, 0.5}) {  // Left edge, right edge or middle of the text at the point.
      for (const double level : {0.5, 0.0, 1.0}) {  // Beside, above or below it.
        if (side == 0.5 && level == 0.5) continue;
        const Eigen::Vector2d corner = {at.x() - side * size.x() + (1 - 2 * side) * away,
                                        at.y() - size.y() / 2 + (2 * level - 1) * (size.y() / 2 + away)};
        const Eigen::AlignedBox2d box = text_box(corner, content);
        const double total = cost(box) + 0.1 * away;
        if (total < least) {
          least = total;
          best = box;
        }
      }
    }
  }
  svg.label({best.min().x(), best.min().y() + 13.0}, "halo", content);
  for (double x = best.min().x() - 2.0; x <= best.max().x() + 6.0; x += 6.0) {
    for (double y = best.min().y() - 2.0; y <= best.max().y() + 6.0; y += 6.0) avoid({x, y}, 100.0);
  }
}

}  // namespace flexura
