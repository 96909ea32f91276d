#include "flexura/render/shadow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flexura {
namespace {

// Returns the fraction of a round light source that is visible beyond a straight edge at `height` light radii
// above the source's middle.
double share_over_edge(double height) {
  if (height >= 1) return 0;
  if (height <= -1) return 1;
  return 0.5 - (height * std::sqrt(1 - height * height) + std::asin(height)) / std::numbers::pi;
}

// Returns the fraction of the light that passes a ball around `center`; 1 for points inside the ball.
double share_past_ball(const Eigen::Vector3d& center, double radius, const Eigen::Vector3d& p_CQ,
                       const Eigen::Vector3d& light, double width) {
  const Eigen::Vector3d way = center - p_CQ;
  const double along = way.dot(light);
  if (!(along > 0) || !(way.norm() > radius * (1 + 1e-9))) return 1;
  return 1 - share_over_edge(((way - along * light).norm() - radius) / (width * along));
}

// Share of the light past the disc that closes a flat end, for a point beyond the disc's plane; 1 for other
// points. The disc's edge is approximated by a straight line.
double share_past_disc(const Eigen::Vector3d& center, const Eigen::Vector3d& outward, double radius,
                       const Eigen::Vector3d& p_CQ, const Eigen::Vector3d& light, double width) {
  const double height = (p_CQ - center).dot(outward), slope = -light.dot(outward);
  if (!(height > 0) || !(slope > 0)) return 1;
  const double along = height / slope;
  const double gap = (p_CQ + along * light - center).norm() - radius;
  return 1 - share_over_edge(gap / (width * along));
}

// Share of the light that reaches the point past the arm. Where the line to the light's middle is nearest to
// the tube, the tube's edge is approximated by a straight line. The shadow's ends are round.
double light_past_arm(const Stage& stage, const Eigen::Vector3d& p_CQ) {
  const double width = stage.scene->light.angular_radius;
  double share = 1;
  for (int i = stage.first_arm_piece; i <= stage.last_arm_piece; ++i) {
    const TubePiece& piece = stage.pieces[static_cast<std::size_t>(i)];
    const LocalRay way = local_ray(piece, p_CQ, stage.light);
    const double farthest = (piece.bound_center - way.origin).norm() + piece.bound_radius;
    const Eigen::Vector3d end = piece.p_CP + piece.R_CP * (2 * piece.bound_center);
    if (piece.before < 0) {
      share = std::min(share, share_past_ball(piece.p_CP, piece.radius, p_CQ, stage.light, width));
      share = std::min(
          share, share_past_disc(piece.p_CP, -piece.R_CP.col(2), piece.radius, p_CQ, stage.light, width));
    }
    if (piece.after < 0) {
      const double radius = piece.radius + piece.widening * piece.length;
      const Eigen::Vector3d tangent = piece.R_CP * piece.end_tangent;
      share = std::min(share, share_past_ball(end, radius, p_CQ, stage.light, width));
      share = std::min(share, share_past_disc(end, tangent, radius, p_CQ, stage.light, width));
    }
    const DepthRange range = range_of(piece, way, piece.bound_radius + width * farthest);
    if (range.is_empty()) continue;
    const double lowest = first_minimum(piece, way, range.from, range);
    if (lowest <= range.from || std::isinf(lowest)) continue;
    const TubePoint near = tube_point(piece, p_CQ + lowest * stage.light);
    share = std::min(share, 1 - share_over_edge(near.gap / (width * lowest)));
  }
  return share;
}

// Share of the light past a convex body, by the largest distance of the line to the light's middle from the
// lines along the body's outline.
double light_past(const Caster& caster, const Stage& stage, const Eigen::Vector3d& p_CQ) {
  const Eigen::Vector3d off = p_CQ - caster.center;
  const double along = -off.dot(stage.light);
  if (!(along > 0)) return 1;
  double gap = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < caster.count; ++i) {
    const CasterSide& side = stage.caster_sides[caster.first + i];
    gap = std::max(gap, side.normal.dot(off) - side.reach);
  }
  return 1 - share_over_edge(gap / (stage.scene->light.angular_radius * along));
}

// Adds the outline's line across `normal`; `reach_along` returns the extent of the body in a direction.
template <typename Reach>
void add_side(const Eigen::Vector3d& normal, Reach&& reach_along, Stage& stage) {
  stage.caster_sides.push_back({normal, reach_along(normal)});
  ++stage.casters.back().count;
}

}  // namespace

void add_caster(const Arc& tube, TipKind ends, const Pose& X_CW, Stage& stage) {
  if (stage.scene->light.shadow == 0) return;
  const Eigen::Vector3d axis = X_CW.rotation * tube.X_WS.rotation.col(2);
  const Eigen::Vector3d half_way = 0.5 * tube.length * axis;
  stage.casters.push_back({X_CW * tube.X_WS.position + half_way, stage.caster_sides.size(), 0});
  const auto reach = [&](const Eigen::Vector3d& n) {
    const double cosine = axis.dot(n);
    const double across = ends == TipKind::round ? 1 : std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return std::abs(half_way.dot(n)) + tube.radius[0] * across;
  };
  // The first one along the tube's side.
  Eigen::Vector3d x = stage.light.cross(axis);
  x = x.norm() > 1e-6 ? Eigen::Vector3d(x.normalized()) : stage.light.unitOrthogonal();
  const Eigen::Vector3d y = stage.light.cross(x);
  constexpr int sides = 64;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    add_side(std::cos(angle) * x + std::sin(angle) * y, reach, stage);
  }
}

void add_caster(const Pose& X_CB, const std::array<double, 3>& half_sizes, Stage& stage) {
  if (stage.scene->light.shadow == 0) return;
  stage.casters.push_back({X_CB.position, stage.caster_sides.size(), 0});
  const Eigen::Vector3d halves(half_sizes[0], half_sizes[1], half_sizes[2]);
  const auto reach = [&](const Eigen::Vector3d& n) {
    return halves.dot((X_CB.rotation.transpose() * n).cwiseAbs());
  };
  // Lines along its edges.
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d normal = stage.light.cross(X_CB.rotation.col(axis));
    if (!(normal.norm() > 1e-6)) continue;
    add_side(normal.normalized(), reach, stage);
    add_side(-normal.normalized(), reach, stage);
  }
}

double shadow_at(const Stage& stage, const Eigen::Vector3d& p_CQ, bool of_all) {
  const double depth_of_shadow = stage.scene->light.shadow;
  if (depth_of_shadow == 0) return 1;
  double share = light_past_arm(stage, p_CQ);
  if (of_all) {
    for (const Caster& caster : stage.casters) share = std::min(share, light_past(caster, stage, p_CQ));
  }
  return 1 - depth_of_shadow * (1 - share);
}

}  // namespace flexura
