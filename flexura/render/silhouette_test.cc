#include "flexura/render/silhouette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "flexura/render/prepared_scene.h"
#include "flexura/render/tracer.h"
#include "tests/support/arms.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// Distance of a point in W to the backbone, by a dense search and a golden section: independent of the
// renderer's equations.
double distance_to_backbone(const Backbone& backbone, const Eigen::Vector3d& p, double near_s) {
  const auto distance = [&](double s) {
    return (backbone.pose(std::clamp(s, 0.0, backbone.length())).position - p).norm();
  };
  double low = near_s - 0.02, high = near_s + 0.02;
  for (int step = 0; step < 60; ++step) {
    const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
    (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
  }
  return distance(0.5 * (low + high));
}

TEST(Outlines, AreWhereRaysTouchTheTube) {
  for_random_cases(10, [](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0);
    const Backbone backbone = bent.backbone();
    const double radius = bent.arm.sections[0].radius[0];
    Scene scene = plain_scene();
    scene.arm.tube = tube_of(backbone);
    const View view = random_view_of(random, backbone);
    Renderer renderer;
    renderer.prepare(scene, view);
    int visible = 0;
    for (const Outline& outline : outlines(renderer, 4)) {
      for (const OutlinePoint& point : outline.points) {
        visible += point.is_visible ? 1 : 0;
        const Eigen::Vector3d p = view.X_WC * point.p_CP;
        EXPECT_NEAR(distance_to_backbone(backbone, p, point.s), radius, 1e-9);
        if (outline.kind == OutlineKind::rim || point.s < 0.03 || point.s > 0.96) continue;
        // Slightly before and behind along the ray the distance is equal to first order.
        const Eigen::Vector3d along = (p - view.X_WC.position).normalized();
        constexpr double step = 1e-4;
        const double before = distance_to_backbone(backbone, p - step * along, point.s);
        const double behind = distance_to_backbone(backbone, p + step * along, point.s);
        // The curvature jumps where sections meet.
        EXPECT_NEAR(behind - before, 0, 2e-7);
      }
    }
    EXPECT_GT(visible, 20);
  });
}

TEST(Outlines, ThatAreSeenPartTheArmFromTheBackground) {
  for_random_cases(10, [](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.006);
    const Backbone backbone = bent.backbone();
    Scene scene = plain_scene();
    scene.arm.tube = tube_of(backbone);
    scene.arm.tip = TipKind::round;
    const View view = random_view_of(random, backbone);
    Renderer renderer;
    renderer.prepare(scene, view);
    const Tracer tracer(renderer.prepared().stage, renderer.prepared().tiles.all_parts());
    const auto depth_at = [&](const Eigen::Vector2d& pixel) {
      return tracer.hit(*ray_at(view.lens, pixel)).depth;
    };
    int checked = 0, parting = 0;
    for (const Outline& outline : outlines(renderer, 3)) {
      if (outline.kind == OutlineKind::rim) continue;
      for (std::size_t i = 2; i + 2 < outline.points.size(); ++i) {
        const OutlinePoint &before = outline.points[i - 1], &here = outline.points[i],
                           &after = outline.points[i + 1];
        if (!here.is_visible || !before.is_visible || !after.is_visible) continue;
        const Eigen::Vector2d along = *after.pixel - *before.pixel;
        if (along.norm() < 1e-3) continue;
        const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
        const double left = depth_at(*here.pixel + 0.02 * normal),
                     right = depth_at(*here.pixel - 0.02 * normal);
        ++checked;
        // On one side is the arm, as near as the point; on the other something farther away.
        const double nearer = std::min(left, right), farther = std::max(left, right);
        if (std::abs(nearer - here.p_CP.z()) < 0.02 && farther > here.p_CP.z() + 1e-3) ++parting;
      }
    }
    EXPECT_GT(checked, 20);
    // Except at the cusps where a contour becomes hidden.
    EXPECT_GT(parting, 0.97 * checked) << parting << " of " << checked;
  });
}

TEST(Outlines, OfAStraightTubeSeenFromTheSideAreTwoLinesAndTwoRims) {
  Arm arm;
  arm.sections.push_back({.length = 1, .radius = {0.05, 0.05}});
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(Backbone(arm, ArmState::straight(1)));
  Renderer renderer;
  renderer.prepare(scene, pinhole_view(look_at({0, 0.5, 2}, {0, 0.5, 0}), 200, 200, 150));
  const auto found = outlines(renderer);
  ASSERT_EQ(found.size(), 4U);
  const double off = 150 * 0.05 / std::sqrt(2 * 2 - 0.05 * 0.05);
  for (std::size_t side = 0; side < 2; ++side) {
    EXPECT_EQ(found[side].kind, OutlineKind::contour);
    for (const OutlinePoint& point : found[side].points) {
      EXPECT_NEAR(std::abs(point.pixel->x() - 99.5), off, 1e-9);
      EXPECT_TRUE(point.is_visible);
    }
  }
  EXPECT_EQ(found[2].kind, OutlineKind::rim);
  EXPECT_EQ(found[3].kind, OutlineKind::rim);
}

TEST(Outlines, OfATubeSeenFromItsEndHaveNoContour) {
  Arm arm;
  arm.sections.push_back({.length = 1, .radius = {0.05, 0.05}});
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(Backbone(arm, ArmState::straight(1)));
  Renderer renderer;
  renderer.prepare(scene, pinhole_view(look_at({0, 3, 0}, {0, 0, 0}, {1, 0, 0}), 100, 100, 100));
  for (const Outline& outline : outlines(renderer)) EXPECT_EQ(outline.kind, OutlineKind::rim);
  EXPECT_THROW((void)outlines(renderer, 0), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
