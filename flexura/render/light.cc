#include <algorithm>

#include "flexura/render/shadow.h"
#include "flexura/render/tracer.h"

namespace flexura {
namespace {

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

SurfaceLabel arm_label(const Stage& stage, const TubePiece& piece, double s) {
  const auto next = std::ranges::upper_bound(stage.rings, s, {}, &RingStretch::s);
  const int marker = next == stage.rings.begin() ? -1 : (next - 1)->marker;
  if (marker >= 0) return {SurfaceKind::marker, static_cast<std::uint16_t>(marker)};
  return {SurfaceKind::section, static_cast<std::uint16_t>(stage.scene->arm.tube[piece.tube_arc].section)};
}

Color light_of(const Stage& stage, const Hit& hit, const Ray& ray) {
  if (hit.is_none()) return stage.scene->background;
  const Eigen::Vector3d p_CQ = hit.depth * ray.direction;
  if (hit.label.kind == SurfaceKind::screen) {
    const FacePart& face = stage.faces[hit.part.index];
    return screen_light(stage.scene->screens[hit.label.index], face.face, p_CQ) *
           shadow_at(stage, p_CQ, true);
  }
  const Light& light = stage.scene->light;
  const int body = body_of(stage, hit.part);
  double directional = light.directional * std::max(0.0, hit.normal.dot(stage.light));
  const bool takes_all = stage.bodies[static_cast<std::size_t>(body)].takes_all_shadows;
  if (directional > 0) directional *= shadow_at(stage, p_CQ, takes_all);
  return albedo_of(stage, hit, body) * (light.ambient + directional);
}

}  // namespace flexura
