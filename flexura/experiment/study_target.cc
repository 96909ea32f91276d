#include "flexura/experiment/study_target.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/camera/mount.h"
#include "flexura/model/backbone.h"
#include "flexura/render/truth.h"

namespace flexura {
namespace {

using std::numbers::pi;

constexpr double tube_radius = 0.005;  // of the circle's
constexpr double ring_width = 0.02;    // likewise

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

// How far along the tube the circle begins, as a share of the circle's radius.
constexpr double lead_in = pi / 2;

double along_tube(std::size_t i, double radius) {
  return radius * (lead_in + 2 * pi * static_cast<double>(i) / circle_points);
}

// A tube that starts in the centre towards -x, takes a half circle to the lowest point and goes on around.
Scene scene_of(const Pose& X_WF, double radius) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.X_WB.position = X_WF.position;
  arm.X_WB.rotation.col(0) = -X_WF.rotation.col(1);
  arm.X_WB.rotation.col(1) = X_WF.rotation.col(2);
  arm.X_WB.rotation.col(2) = -X_WF.rotation.col(0);
  const std::array<double, 2> thin = {tube_radius * radius, tube_radius * radius};
  arm.sections = {{.length = lead_in * radius, .radius = thin}, {.length = 2 * pi * radius, .radius = thin}};
  ArmState state = ArmState::straight(2);
  state.bends = {{pi, 0}, {2 * pi, 0}};
  Scene scene;
  scene.arm.tube = tube_of(arm, Backbone(arm, state));
  for (const std::size_t i : {bottom_right, top_right, circle_top, top_left, bottom_left}) {
    const double s = along_tube(i, radius), half = 0.5 * ring_width * radius;
    scene.arm.markers.push_back({.s_from = s - half, .s_to = s + half});
  }
  return scene;
}

}  // namespace

StudyTarget::StudyTarget(const StudyTargetConfig& config)
    : X_WF_(pose_of(config)), radius_(config.radius), scene_(scene_of(X_WF_, radius_)) {}

Eigen::Vector3d StudyTarget::point(std::size_t i) const {
  const double angle = 2 * pi * static_cast<double>(i) / circle_points;
  return X_WF_ * Eigen::Vector3d(radius_ * std::sin(angle), -radius_ * std::cos(angle), 0);
}

TargetImage StudyTarget::projected(const View& view) const {
  TargetImage image;
  image.center = view.project(center());
  for (std::size_t i = 0; i < circle_points; ++i) image.circle[i] = view.project(point(i));
  return image;
}

TargetImage StudyTarget::rendered(const View& view, Renderer& renderer) const {
  // The backbone's pixels do not depend on the image's size, but the time to prepare does.
  View small = view;
  small.width = small.height = 2;
  renderer.prepare(scene_, small);
  std::vector<double> s = {0};
  for (std::size_t i = 0; i < circle_points; ++i) s.push_back(along_tube(i, radius_));
  const std::vector<AxisPoint> points = projected_axis(renderer, s);
  TargetImage image;
  image.center = points[0].pixel;
  for (std::size_t i = 0; i < circle_points; ++i) image.circle[i] = points[i + 1].pixel;
  return image;
}

}  // namespace flexura
