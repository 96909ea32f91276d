#include "flexura/report/arm_curve.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace flexura {
namespace {

// A chord nearer than this to its arc is drawn as the arc (page units; a thousandth is what paths are rounded
// to).
constexpr double flat_enough = 5e-4;

int pieces_of(double angle, double largest) { return static_cast<int>(std::floor(angle / largest)) + 1; }

// +1 when the arc turns counter-clockwise in the XOY view, else -1.
double turn_sense(const Arc& arc) {
  const Eigen::Matrix3d& R_WS = arc.X_WS.rotation;
  const Eigen::Vector3d inward = R_WS.col(0) * arc.bend.x() + R_WS.col(1) * arc.bend.y();
  return R_WS.col(2).cross(inward).z() < 0.0 ? -1.0 : 1.0;
}

Eigen::Vector2d normal_of(const Eigen::Vector2d& tangent, const Eigen::Vector2d& otherwise) {
  const double length = tangent.norm();
  // Seen end on, an arc has no side.
  return length < 1e-6 ? otherwise : Eigen::Vector2d(-tangent.y() / length, tangent.x() / length);
}

}  // namespace

Eigen::Vector2d seen(PlotView view, const Eigen::Vector3d& p_W) {
  return {view == PlotView::xoy ? p_W.x() : p_W.z(), p_W.y()};
}

bool lies_in_xoy(const Arm& arm) {
  return arm.kind == ArmKind::planar && std::abs(std::abs(arm.X_WB.rotation(2, 1)) - 1.0) < 1e-12;
}

std::vector<CirclePiece> circle_pieces(const Arc& arc) {
  const double theta = arc.bend.norm();
  const int count = pieces_of(theta, std::numbers::pi / 2);
  const double radius = theta > 0.0 ? arc.length / theta : std::numeric_limits<double>::infinity();
  const double angle = theta > 0.0 ? turn_sense(arc) * theta / count : 0.0;
  std::vector<CirclePiece> pieces;
  Eigen::Vector2d from = seen(PlotView::xoy, arc.X_WS.position);
  for (int i = 1; i <= count; ++i) {
    const Eigen::Vector2d to = seen(PlotView::xoy, arc.pose(arc.length * i / count).position);
    pieces.push_back({from, to, radius, angle});
    from = to;
  }
  return pieces;
}

std::vector<Bezier> bezier_pieces(const Arc& arc, PlotView view) {
  const double theta = arc.bend.norm();
  const int count = pieces_of(theta, std::numbers::pi / 4);
  const double length = arc.length / count;
  const double quarter = theta / count / 4;
  // (4/3) tan(angle/4) of the radius; a third of the length where straight.
  const double handle = length / 3 * (quarter < 1e-5 ? 1.0 : std::tan(quarter) / quarter);
  std::vector<Bezier> pieces;
  Pose from = arc.X_WS;
  for (int i = 1; i <= count; ++i) {
    const Pose to = arc.pose(length * i);
    pieces.push_back({seen(view, from.position), seen(view, from.position + handle * from.rotation.col(2)),
                      seen(view, to.position - handle * to.rotation.col(2)), seen(view, to.position)});
    from = to;
  }
  return pieces;
}

std::string arc_path(const Arc& arc, PlotView view, const PlotFrame& frame, bool in_plane) {
  std::string path = 'M' + page_point(frame.page(seen(view, arc.X_WS.position)));
  if (!in_plane) {
    for (const Bezier& bezier : bezier_pieces(arc, view)) {
      path += fmt::format("C{} {} {}", page_point(frame.page(bezier[1])), page_point(frame.page(bezier[2])),
                          page_point(frame.page(bezier[3])));
    }
    return path;
  }
  for (const CirclePiece& piece : circle_pieces(arc)) {
    const Eigen::Vector2d to = frame.page(piece.to);
    const double chord = (to - frame.page(piece.from)).norm();
    if (chord * std::abs(piece.angle) / 8 < flat_enough) {
      path += 'L' + page_point(to);
      continue;
    }
    // SVG's sweep is positive from +x to +y, which is clockwise to the eye.
    const std::string radius = page_number(piece.radius * frame.scale().x());
    path += fmt::format("A{0} {0} 0 0 {1} {2}", radius, piece.angle > 0.0 ? 0 : 1, page_point(to));
  }
  return path;
}

std::string taper_path(const Arc& arc, PlotView view, const PlotFrame& frame, std::array<double, 2> radius) {
  const int steps = 8 * pieces_of(arc.bend.norm(), std::numbers::pi / 4);
  std::vector<Eigen::Vector2d> left;
  std::vector<Eigen::Vector2d> right;
  Eigen::Vector2d normal = {1.0, 0.0};
  for (int i = 0; i <= steps; ++i) {
    const double part = static_cast<double>(i) / steps;
    const Pose X_WS = arc.pose(arc.length * part);
    const Eigen::Vector2d at = frame.page(seen(view, X_WS.position));
    const Eigen::Vector2d tangent = seen(view, X_WS.rotation.col(2));
    normal = normal_of({tangent.x(), -tangent.y()}, normal);
    const double half = radius[0] + (radius[1] - radius[0]) * part;
    left.emplace_back(at + half * normal);
    right.emplace_back(at - half * normal);
  }
  left.insert(left.end(), right.rbegin(), right.rend());
  return polyline_path(left) + 'Z';
}

}  // namespace flexura
