#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "flexura/render/tracer.h"

namespace flexura {
namespace {

// The share of a round light that is seen past a straight edge, `height` of the light's radii over its
// middle.
double share_over_edge(double height) {
  if (height >= 1) return 0;
  if (height <= -1) return 1;
  return 0.5 - (height * std::sqrt(1 - height * height) + std::asin(height)) / std::numbers::pi;
}

// The share of the light past a ball around `center`.
double share_past_ball(const Eigen::Vector3d& center, double radius, const Eigen::Vector3d& p_CQ,
                       const Eigen::Vector3d& light, double width) {
  const Eigen::Vector3d way = center - p_CQ;
  const double along = way.dot(light);
  if (!(along > 0)) return 1;
  return 1 - share_over_edge(((way - along * light).norm() - radius) / (width * along));
}

// How much of the light reaches the point past the arm: where the way to the light's middle comes nearest to
// the tube, the tube's edge is taken for straight. The shadow's ends are round.
double light_past_arm(const Stage& stage, const Eigen::Vector3d& p_CQ) {
  const double width = stage.scene->light.angular_radius;
  double share = 1;
  for (int i = stage.first_arm_piece; i <= stage.last_arm_piece; ++i) {
    const TubePiece& piece = stage.pieces[static_cast<std::size_t>(i)];
    const LocalRay way = local_ray(piece, p_CQ, stage.light);
    const double farthest = (piece.bound_center - way.origin).norm() + piece.bound_radius;
    const Eigen::Vector3d end = piece.p_CP + piece.R_CP * (2 * piece.bound_center);
    if (piece.before < 0)
      share = std::min(share, share_past_ball(piece.p_CP, piece.radius, p_CQ, stage.light, width));
    if (piece.after < 0)
      share = std::min(share, share_past_ball(end, piece.radius + piece.widening * piece.length, p_CQ,
                                              stage.light, width));
    const DepthRange range = range_of(piece, way, piece.bound_radius + width * farthest);
    if (range.is_empty()) continue;
    const double lowest = first_minimum(piece, way, range.from, range);
    if (lowest <= range.from || std::isinf(lowest)) continue;
    const TubePoint near = tube_point(piece, p_CQ + lowest * stage.light);
    share = std::min(share, 1 - share_over_edge(near.gap / (width * lowest)));
  }
  return share;
}

double shadow_at(const Stage& stage, const Eigen::Vector3d& p_CQ) {
  const double depth_of_shadow = stage.scene->light.shadow;
  if (depth_of_shadow == 0) return 1;
  return 1 - depth_of_shadow * (1 - light_past_arm(stage, p_CQ));
}

Color screen_light(const Screen& screen, const Face& face, const Eigen::Vector3d& p_CQ) {
  const Eigen::Vector3d along_x = 0.5 * (face.corners[1] - face.corners[0]);
  const Eigen::Vector3d along_y = 0.5 * (face.corners[3] - face.corners[0]);
  const Eigen::Vector3d off = p_CQ - 0.5 * (face.corners[0] + face.corners[2]);
  const double x = off.dot(along_x) / along_x.squaredNorm(), y = off.dot(along_y) / along_y.squaredNorm();
  const double factor =
      (1 + screen.gradient[0] * x + screen.gradient[1] * y) * (1 - screen.falloff * 0.5 * (x * x + y * y));
  return screen.brightness * std::max(0.0, factor);
}

Color albedo_of(const Stage& stage, const Hit& hit, int body) {
  const Scene& scene = *stage.scene;
  if (hit.label.kind == SurfaceKind::marker) return scene.arm.markers[hit.label.index].albedo;
  if (hit.label.kind == SurfaceKind::etalon_line) return scene.etalon->line_albedo;
  return stage.bodies[static_cast<std::size_t>(body)].albedo;
}

int body_of(const Stage& stage, Part part) {
  switch (part.kind) {
    case Part::Kind::piece:
      return stage.pieces[part.index].body;
    case Part::Kind::disc:
      return stage.discs[part.index].body;
    case Part::Kind::face:
      return stage.faces[part.index].body;
    case Part::Kind::plane:
      return stage.planes[part.index].body;
  }
  return 0;
}

}  // namespace

Color light_of(const Stage& stage, const Hit& hit, const Ray& ray) {
  if (hit.is_none()) return stage.scene->background;
  const Eigen::Vector3d p_CQ = hit.depth * ray.direction;
  if (hit.label.kind == SurfaceKind::screen) {
    const FacePart& face = stage.faces[hit.part.index];
    return screen_light(stage.scene->screens[hit.label.index], face.face, p_CQ) * shadow_at(stage, p_CQ);
  }
  const Light& light = stage.scene->light;
  const int body = body_of(stage, hit.part);
  double directional = light.directional * std::max(0.0, hit.normal.dot(stage.light));
  if (stage.bodies[static_cast<std::size_t>(body)].takes_shadow) directional *= shadow_at(stage, p_CQ);
  return albedo_of(stage, hit, body) * (light.ambient + directional);
}

}  // namespace flexura
