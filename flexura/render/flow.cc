#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "flexura/render/prepared_scene.h"
#include "flexura/render/tracer.h"
#include "flexura/render/truth.h"

namespace flexura {
namespace {

// Maps points of one scene to their positions in another.
class Carrier {
 public:
  Carrier(const Scene& from, const Scene& to) : from_(from), to_(to) {
    if (from.arm.tube.size() != to.arm.tube.size() || from.arm.disks.size() != to.arm.disks.size() ||
        from.screens.size() != to.screens.size() || from.etalon.has_value() != to.etalon.has_value())
      throw std::invalid_argument(
          "the two scenes have different numbers of arcs, disks or screens, or only one has an etalon");
  }

  // Returns the new position in W of the point p of `hit`'s surface.
  [[nodiscard]] Eigen::Vector3d carry(const Stage& stage, const Hit& hit, const Eigen::Vector3d& p) const {
    switch (hit.label.kind) {
      case SurfaceKind::section:
      case SurfaceKind::marker:
      case SurfaceKind::cap:
      case SurfaceKind::disk:
        return carry_with_arm(stage, hit, p);
      case SurfaceKind::screen: {
        const std::size_t i = hit.label.index;
        return to_.screens[i].X_WS * (from_.screens[i].X_WS.inverse() * p);
      }
      case SurfaceKind::etalon:
      case SurfaceKind::etalon_line:
        return to_.etalon->X_WE * (from_.etalon->X_WE.inverse() * p);
      case SurfaceKind::background:
      case SurfaceKind::obstacle:
        break;
    }
    return p;
  }

 private:
  [[nodiscard]] Eigen::Vector3d carry_with_arm(const Stage& stage, const Hit& hit,
                                               const Eigen::Vector3d& p) const {
    std::size_t arc = 0;
    double along = 0;
    if (hit.label.kind == SurfaceKind::disk) {
      arc = static_cast<std::size_t>(&tube_arc_at(from_.arm.tube, hit.s) - from_.arm.tube.data());
      along = hit.s - from_.arm.tube[arc].s;
    } else if (hit.part.kind == Part::Kind::piece) {
      const TubePiece& piece = stage.pieces[hit.part.index];
      arc = piece.tube_arc;
      along = piece.start_in_arc + (hit.s - piece.s);
    } else {
      arc = stage.discs[hit.part.index].tube_arc;
      along = stage.discs[hit.part.index].along;
    }
    const Arc &before = from_.arm.tube[arc], &after = to_.arm.tube[arc];
    along = std::clamp(along, 0.0, before.length);
    return after.pose(along * (after.length / before.length)) * (before.pose(along).inverse() * p);
  }

  const Scene& from_;
  const Scene& to_;
};

}  // namespace

Image<float> optical_flow(const Renderer& renderer, const Scene& scene, const View& view) {
  check(scene);
  check_camera(view.X_WC);
  const Stage& stage = renderer.prepared().stage;
  const Carrier carrier(*stage.scene, scene);
  const RayField& rays = renderer.prepared().rays;
  Image<float> flow(rays.width(), rays.height(), 2, std::numeric_limits<float>::quiet_NaN());
  for (int v = 0; v < rays.height(); ++v) {
    for (int u = 0; u < rays.width(); ++u) {
      const auto ray = rays.ray(u, v);
      const auto parts = renderer.prepared().tiles.parts(u / Tiles::size, v / Tiles::size);
      if (!ray || parts.empty()) continue;
      const Hit hit = Tracer(stage, parts).hit(*ray);
      if (hit.is_none()) continue;
      const Eigen::Vector3d p_WP =
          renderer.prepared().view.X_WC * Eigen::Vector3d(hit.depth * ray->direction);
      const auto pixel = view.project(carrier.carry(stage, hit, p_WP));
      if (!pixel) continue;
      flow.at(u, v, 0) = static_cast<float>(pixel->x() - u);
      flow.at(u, v, 1) = static_cast<float>(pixel->y() - v);
    }
  }
  return flow;
}

}  // namespace flexura
