#include "flexura/study/study_target.h"

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "flexura/camera/mount.h"
#include "flexura/math/dense.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/scene.h"
#include "flexura/render/tracer.h"

namespace flexura {
namespace {

using std::numbers::pi;

Pose pose_of(const StudyTargetConfig& config) {
  const Eigen::Vector3d z = Eigen::Vector3d(config.normal.data()).stableNormalized();
  const auto seen = upright(-z);
  Pose X_WF;
  X_WF.position = Eigen::Vector3d(config.center.data());
  X_WF.rotation.col(0) = seen ? Eigen::Vector3d(seen->col(0)) : Eigen::Vector3d::UnitX();
  X_WF.rotation.col(1) = z.cross(X_WF.rotation.col(0)).normalized();
  X_WF.rotation.col(2) = X_WF.rotation.col(0).cross(X_WF.rotation.col(1));
  return X_WF;
}

// Returns a screen in the target's plane, large enough for the circle and the pixels around it.
Scene scene_of(const Pose& X_WF, double radius, const Eigen::Vector3d& eye) {
  constexpr double pixels = 0.1;  // Share of the distance: sufficient even for a lens of 10 px.
  const double side = 4 * radius + pixels * (eye - X_WF.position).norm();
  Scene scene;
  Screen& screen = scene.screens.emplace_back();
  screen.X_WS = X_WF;
  screen.size = {side, side};
  return scene;
}

// Intersections of rays of the prepared renderer's view with its scene.
class RayMeeting {
 public:
  explicit RayMeeting(const Renderer& renderer)
      : view_(renderer.prepared().view),
        tracer_(renderer.prepared().stage, renderer.prepared().tiles.all_parts()) {}

  // Returns the point in W; std::nullopt if the pixel has no ray, or its ray meets nothing.
  [[nodiscard]] std::optional<Eigen::Vector3d> at(const Eigen::Vector2d& pixel) const {
    const auto ray = ray_at(view_.lens, pixel);
    if (!ray) return std::nullopt;
    const Hit hit = tracer_.hit(*ray);
    if (hit.is_none()) return std::nullopt;
    return view_.X_WC * Eigen::Vector3d(hit.depth * ray->direction);
  }

  // Returns the pixel whose ray meets the point p_WP; the search starts from another pixel.
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& p_WP,
                                                        Eigen::Vector2d pixel) const {
    constexpr int most_steps = 30;
    constexpr double difference = 1e-3, small = 1e-9;  // In px.
    for (int i = 0; i < most_steps; ++i) {
      const auto here = at(pixel), right = at(pixel + Eigen::Vector2d(difference, 0)),
                 below = at(pixel + Eigen::Vector2d(0, difference));
      if (!here || !right || !below) return std::nullopt;
      Eigen::Matrix<double, 3, 2> by_pixel;
      by_pixel << *right - *here, *below - *here;
      const Eigen::Vector2d step = least_norm_solution(by_pixel / difference, p_WP - *here);
      if (!step.allFinite()) return std::nullopt;
      pixel += step;
      if (step.norm() < small) return pixel;
    }
    return std::nullopt;
  }

 private:
  const View& view_;
  Tracer tracer_;
};

}  // namespace

StudyTarget::StudyTarget(const StudyTargetConfig& config) : X_WF_(pose_of(config)), radius_(config.radius) {}

Eigen::Vector2d StudyTarget::plane_point(std::size_t i) const {
  const double angle = 2 * pi * static_cast<double>(i) / circle_points;
  return {radius_ * std::sin(angle), -radius_ * std::cos(angle)};
}

Eigen::Vector3d StudyTarget::point(std::size_t i) const {
  const Eigen::Vector2d place = plane_point(i);
  return X_WF_ * Eigen::Vector3d(place.x(), place.y(), 0);
}

TargetImage StudyTarget::projected(const View& view) const {
  TargetImage image;
  image.center = view.project(center());
  for (std::size_t i = 0; i < circle_points; ++i) image.circle[i] = view.project(point(i));
  return image;
}

TargetImage StudyTarget::rendered(const View& view, Renderer& renderer) const {
  // The ray of a pixel does not depend on the image's size, but the time to prepare does.
  View small = view;
  small.width = small.height = 2;
  const Scene scene = scene_of(X_WF_, radius_, view.X_WC.position);
  renderer.prepare(scene, small);
  const RayMeeting rays(renderer);
  const auto found = [&](const Eigen::Vector3d& p_WP) -> std::optional<Eigen::Vector2d> {
    const auto near = view.project(p_WP);
    if (!near) return std::nullopt;
    return rays.pixel_of(p_WP, near->array().round());
  };
  TargetImage image;
  image.center = found(center());
  for (std::size_t i = 0; i < circle_points; ++i) image.circle[i] = found(point(i));
  return image;
}

}  // namespace flexura
