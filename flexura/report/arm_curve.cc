#include "flexura/report/arm_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flexura {

Eigen::Vector2d seen(PlotView view, const Eigen::Vector3d& p_W) {
  return {view == PlotView::xoy ? p_W.x() : p_W.z(), p_W.y()};
}

bool lies_in_xoy(const Arm& arm) {
  return arm.kind == ArmKind::planar && std::abs(std::abs(arm.X_WB.rotation(2, 1)) - 1.0) < 1e-12;
}

std::vector<Eigen::Vector2d> arc_points(const Arc& arc, PlotView view, const PlotFrame& frame,
                                        std::array<double, 2> aside) {
  // Beyond some hundred turns nothing more can be seen.
  constexpr double most = 1000;
  const int steps = 16 * (1 + static_cast<int>(std::min(most, arc.bend.norm() / (std::numbers::pi / 4))));
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d normal = {1.0, 0.0};
  for (int i = 0; i <= steps; ++i) {
    const double part = static_cast<double>(i) / steps;
    const Pose X_WS = arc.pose(arc.length * part);
    const Eigen::Vector2d tangent = seen(view, X_WS.rotation.col(2));
    // An arc seen end on has no side: the last one is kept.
    if (tangent.norm() > 1e-6) normal = Eigen::Vector2d(tangent.y(), tangent.x()).normalized();
    const double by = aside[0] + (aside[1] - aside[0]) * part;
    points.emplace_back(frame.page(seen(view, X_WS.position)) + by * normal);
  }
  return simplified(points, 0.02);
}

std::string tube_path(const Arc& arc, PlotView view, const PlotFrame& frame, std::array<double, 2> radius) {
  std::vector<Eigen::Vector2d> outline = arc_points(arc, view, frame, radius);
  const auto other = arc_points(arc, view, frame, {-radius[0], -radius[1]});
  outline.insert(outline.end(), other.rbegin(), other.rend());
  return polyline_path(outline) + 'Z';
}

}  // namespace flexura
