#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/math/so3.h"
#include "flexura/render/truth.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// The arm with its disks, a screen and the etalon at one instant.
struct Moment {
  BentArm bent;
  Backbone backbone;
  Pose X_WScreen, X_WEtalon;

  // Arc length from the base of the point at `share` of a section.
  [[nodiscard]] double s(std::size_t section, double share) const {
    return backbone.arcs()[section].s + share * backbone.arcs()[section].length;
  }
  // The point (x, y) of the cross-section there.
  [[nodiscard]] Eigen::Vector3d on_arm(std::size_t section, double share, double distance, double angle,
                                       double over = 0) const {
    const Arc& arc = backbone.arcs()[section];
    return arc.pose(share * arc.length) *
           Eigen::Vector3d(distance * std::cos(angle), distance * std::sin(angle), over);
  }
  [[nodiscard]] Scene scene() const {
    Scene scene = plain_scene();
    scene.arm.tube = tube_of(backbone);
    scene.arm.markers.push_back({s(1, 0.2), s(1, 0.5), {1, 0, 0}});
    for (std::size_t section = 0; section < 3; ++section)
      scene.arm.disks.push_back({s(section, 0.7), 0.045, 0.01});
    scene.screens.push_back({.X_WS = X_WScreen, .size = {1, 0.8}});
    scene.etalon.emplace().X_WE = X_WEtalon;
    return scene;
  }
};

Moment random_moment(TestRandom& random, BentArm bent) {
  for (Eigen::Vector2d& bend : bent.state.bends) bend += random.vector<2>(-0.2, 0.2);
  for (double& stretch : bent.state.stretches) stretch = random.uniform(0.9, 1.1);
  const Backbone backbone = bent.backbone();
  return {.bent = std::move(bent),
          .backbone = backbone,
          .X_WScreen = {so3_exp(random.vector<3>(-0.2, 0.2)), {0.2, 0.3, -1}},
          .X_WEtalon = {so3_exp(random.vector<3>(-0.5, 0.5)), random.vector<3>(0.5, 0.7)}};
}

// A point of a surface at both instants, W.
struct MaterialPoint {
  SurfaceKind kind;
  Eigen::Vector3d before, after;
};

// Random points on all surfaces, visible or hidden.
std::vector<MaterialPoint> random_points(TestRandom& random, const Moment& before, const Moment& after) {
  std::vector<MaterialPoint> points;
  const auto add = [&](SurfaceKind kind, auto&& place) {
    points.push_back({kind, place(before), place(after)});
  };
  for (int i = 0; i < 60; ++i) {
    const auto section = static_cast<std::size_t>(random.integer(0, 2));
    const double share = random.uniform(0, 1), angle = random.uniform(-3.2, 3.2);
    const auto& radius = before.bent.arm.sections[section].radius;
    const double distance = radius[0] + share * (radius[1] - radius[0]);
    const bool is_marked = section == 1 && share > 0.2 && share < 0.5;
    add(is_marked ? SurfaceKind::marker : SurfaceKind::section,
        [&](const Moment& at) { return at.on_arm(section, share, distance, angle); });
    add(SurfaceKind::disk, [&](const Moment& at) {
      return at.on_arm(section, 0.7, 0.027 + 0.018 * share, angle, i % 2 == 0 ? 0.005 : -0.005);
    });
    add(SurfaceKind::disk,
        [&](const Moment& at) { return at.on_arm(section, 0.7, 0.045, angle, 0.005 * (1 - 2 * share)); });
    const double tip = before.bent.arm.sections[2].radius[1];
    add(SurfaceKind::cap, [&](const Moment& at) { return at.on_arm(2, 1, share * tip, angle); });
    const Eigen::Vector3d spot(random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.4), 0);
    add(SurfaceKind::screen, [&](const Moment& at) { return at.X_WScreen * spot; });
    const double line = 0.05 * std::abs(std::remainder(angle, 0.5 * std::numbers::pi));
    add(line < 0.002 ? SurfaceKind::etalon_line : SurfaceKind::etalon, [&](const Moment& at) {
      return at.X_WEtalon *
             Eigen::Vector3d(0.05 * std::sin(angle), 0.3 * share - 0.15, 0.05 * std::cos(angle));
    });
    add(SurfaceKind::etalon, [&](const Moment& at) {
      return at.X_WEtalon *
             Eigen::Vector3d(0.05 * share * std::sin(angle), 0.15, 0.05 * share * std::cos(angle));
    });
  }
  return points;
}

// The view shifted so that the point's image is the middle of pixel (1, 1) of an image of 3 x 3; empty if the
// point is behind the camera.
std::optional<View> aimed(View view, const Eigen::Vector3d& p_WP) {
  const auto pixel = view.project(p_WP);
  if (!pixel) return std::nullopt;
  Intrinsics lens = view.lens.intrinsics();
  lens.cx += 1 - pixel->x(), lens.cy += 1 - pixel->y();
  view.lens = Lens(lens);
  view.width = view.height = 3;
  return view;
}

// Objects, camera pose and zoom all change between the instants.
TEST(Flow, IsWhereMaterialPointsGoBeforeACameraThatMovesAndZooms) {
  std::vector<int> checked(10);
  for_random_cases(12, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.003, 0.004);
    const Moment before = random_moment(random, bent), after = random_moment(random, bent);
    const Scene scene = before.scene(), moved = after.scene();
    const View view = random_view_of(random, before.backbone);
    View view_after = random_view_of(random, before.backbone);
    view_after.X_WC = {view.X_WC.rotation * so3_exp(random.vector<3>(-0.1, 0.1)),
                       view.X_WC.position + random.vector<3>(-0.1, 0.1)};
    Intrinsics zoomed = view_after.lens.intrinsics();
    zoomed.fx *= 1.3, zoomed.fy *= 1.2;
    zoomed.distortion = {-0.1, 0.02, 0.001, -0.001, 0};
    view_after.lens = Lens(zoomed);
    Renderer renderer;
    TruthMaps maps;
    for (const MaterialPoint& point : random_points(random, before, after)) {
      const auto from = aimed(view, point.before);
      if (!from) continue;
      renderer.prepare(scene, *from);
      truth_maps(renderer, maps);
      const double depth = (from->X_WC.inverse() * point.before).z();
      if (!(std::abs(maps.depth.at(1, 1) - depth) < 1e-6 * depth)) continue;  // Something is in front of it.
      EXPECT_EQ(label_from_value(maps.label.at(1, 1)).kind, point.kind);
      const Image<float> flow = optical_flow(renderer, moved, view_after);
      const auto pixel = view_after.project(point.after);
      EXPECT_EQ(pixel.has_value(), !std::isnan(flow.at(1, 1, 0)));
      if (!pixel) continue;
      const double tolerance = 1e-5 + 1e-7 * pixel->norm();  // Near points move far in the image.
      EXPECT_NEAR(flow.at(1, 1, 0), pixel->x() - 1, tolerance);
      EXPECT_NEAR(flow.at(1, 1, 1), pixel->y() - 1, tolerance);
      ++checked[static_cast<std::size_t>(point.kind)];
    }
  });
  for (const SurfaceKind kind : {SurfaceKind::section, SurfaceKind::marker, SurfaceKind::cap,
                                 SurfaceKind::disk, SurfaceKind::screen, SurfaceKind::etalon})
    // In all cases together; a sanitized build has few.
    EXPECT_GT(checked[static_cast<std::size_t>(kind)], one_case_of == 1 ? 20 : -1) << static_cast<int>(kind);
}

TEST(Flow, IsNoNumberWhereNothingIs) {
  TestRandom random(3);
  const BentArm bent = random_bent_arm(random, 0);
  const Backbone backbone = bent.backbone();
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(backbone);
  Renderer renderer;
  const View view = random_view_of(random, backbone);
  renderer.prepare(scene, view);
  TruthMaps maps;
  truth_maps(renderer, maps);
  const Image<float> flow = optical_flow(renderer, scene, view);
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const bool is_background = maps.depth.at(u, v) == std::numeric_limits<float>::infinity();
      EXPECT_EQ(is_background, std::isnan(flow.at(u, v, 0)));
      if (is_background) continue;
      EXPECT_NEAR(flow.at(u, v, 0), 0, 1e-4);
      EXPECT_NEAR(flow.at(u, v, 1), 0, 1e-4);
    }
  }
  Scene shorter = scene;
  shorter.arm.tube.pop_back();
  EXPECT_THROW((void)optical_flow(renderer, shorter, view), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
