#include "flexura/rig/image_motion.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/math/arrays.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

Eigen::Vector3d place(const PlaneConfig& plane) { return vector(plane.point); }
Eigen::Vector3d place(const SphereConfig& sphere) { return vector(sphere.center); }
Eigen::Vector3d place(const CapsuleConfig& capsule) { return vector(capsule.from); }
Eigen::Vector3d place(const BoxConfig& box) { return vector(box.center); }

// Returns points in the image's corners, on its edges and in its middle, at the depth of the stand's nearest
// point. They show the stand's motion in the image of a moving camera.
std::vector<Eigen::Vector3d> stand_points(const Scene& stand, const View& view) {
  double depth = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Eigen::Vector3d& p_W) {
    const double z = (view.X_WC.inverse() * p_W).z();
    if (z > 0) depth = std::min(depth, z);
  };
  for (const Screen& screen : stand.screens) consider(screen.X_WS.position);
  if (stand.etalon) consider(stand.etalon->X_WE.position);
  for (const VisibleObstacle& obstacle : stand.obstacles)
    consider(std::visit([](const auto& shape) { return place(shape); }, obstacle.shape));
  std::vector<Eigen::Vector3d> points;
  if (!std::isfinite(depth)) return points;
  for (const double across : {0.0, 0.5, 1.0}) {
    for (const double down : {0.0, 0.5, 1.0}) {
      const auto normal = view.lens.unproject({across * (view.width - 1), down * (view.height - 1)});
      if (normal) points.emplace_back(view.X_WC * Eigen::Vector3d(depth * normal->homogeneous()));
    }
  }
  return points;
}

using Pixels = std::vector<std::optional<Eigen::Vector2d>>;

Pixels pixels_at(const Shot& shot, const std::vector<Eigen::Vector3d>& points, double time) {
  const View view = shot.view(time);
  const Backbone arm = shot.backbone(time);
  Pixels pixels;
  for (const Eigen::Vector3d& point : points) pixels.push_back(view.project(point));
  for (const Arc& arc : arm.arcs()) pixels.push_back(view.project(arc.X_WS.position));
  pixels.push_back(view.project(arm.tip().position));
  return pixels;
}

}  // namespace

double fastest_image_motion(const Shot& shot, const Scene& stand) {
  const double span = shot.sensor->exposure + last_row_delay(*shot.sensor);
  if (span <= 0) return 0;
  // No arm turns back within less than a millisecond.
  constexpr double least_part = 0.5e-3;  // s
  constexpr double fewest = 2, most = 16;
  const int parts = static_cast<int>(std::clamp(std::ceil(span / least_part), fewest, most));
  const std::vector<Eigen::Vector3d> points = stand_points(stand, shot.view(shot.start));
  double farthest = 0;  // From one time to the next, px.
  Pixels before = pixels_at(shot, points, shot.start);
  for (int part = 1; part <= parts; ++part) {
    Pixels now = pixels_at(shot, points, shot.start + span * part / parts);
    for (std::size_t i = 0; i < now.size(); ++i)
      if (now[i] && before[i]) farthest = std::max(farthest, (*now[i] - *before[i]).norm());
    before = std::move(now);
  }
  return farthest * parts / span;
}

}  // namespace flexura
