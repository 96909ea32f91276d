#include "flexura/render/scene_maker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexura {
namespace {

Arm arm_of_two() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections = {{.length = 1}, {.length = 2}};
  return arm;
}

TEST(SceneMaker, MovesMarkersAndDisksWithTheStretchedArm) {
  LookConfig look;
  look.marker = {{.at = 0.5, .width = 0.2}, {.at = 1, .width = 0.2}, {.at = 2.9, .width = 0.2}};
  look.disk = {{.at = 2, .radius = 0.1, .thickness = 0.01}};
  ArmState state = ArmState::straight(2);
  state.bends[1] = {0.3, 0.4};
  state.stretches = {1.5, 0.5};
  const Arm arm = arm_of_two();
  const Scene scene = SceneMaker(arm, look, {}, {}).scene(Backbone(arm, state));
  check(scene);
  ASSERT_EQ(scene.arm.markers.size(), 3U);
  EXPECT_DOUBLE_EQ(scene.arm.markers[0].s_from, 0.6);
  EXPECT_DOUBLE_EQ(scene.arm.markers[0].s_to, 0.9);
  EXPECT_DOUBLE_EQ(scene.arm.markers[1].s_from, 1.35);
  EXPECT_DOUBLE_EQ(scene.arm.markers[1].s_to, 1.55);
  EXPECT_DOUBLE_EQ(scene.arm.markers[2].s_to, 2.5);
  ASSERT_EQ(scene.arm.disks.size(), 1U);
  EXPECT_DOUBLE_EQ(scene.arm.disks[0].s, 2);
}

TEST(SceneMaker, PutsThePapersScreensBehindTheArm) {
  Arm arm = arm_of_two();
  arm.X_WB.position = {1, 2, 3};
  const Scene scene = SceneMaker(arm, {}, {}, {}).scene(Backbone(arm, ArmState::straight(2)));
  ASSERT_EQ(scene.screens.size(), 2U);
  for (const Screen& screen : scene.screens) {
    EXPECT_NEAR(screen.X_WS.rotation.determinant(), 1, 1e-12);
    EXPECT_TRUE(screen.X_WS.rotation.col(1).isApprox(Eigen::Vector3d(0, 1, 0)));
    // Each faces the base.
    EXPECT_GT(screen.X_WS.rotation.col(2).dot(arm.X_WB.position - screen.X_WS.position), arm.length());
  }
  EXPECT_LT(scene.screens[0].X_WS.position.z(), 3 - arm.length());
  EXPECT_GT(scene.screens[1].X_WS.position.x(), 1 + arm.length());
}

TEST(SceneMaker, StandsTheEtalonOnItsPositionAndCanTakeTheArmAway) {
  StandConfig stand;
  stand.arm = false;
  stand.screen = std::vector<ScreenConfig>{};
  stand.etalon =
      EtalonConfig{.position = {1, 2, 3}, .rotation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}, .height = 0.6};
  const Arm arm = arm_of_two();
  const Scene scene = SceneMaker(arm, {}, stand, {}).scene(Backbone(arm, ArmState::straight(2)));
  EXPECT_TRUE(scene.arm.tube.empty());
  EXPECT_TRUE(scene.screens.empty());
  ASSERT_TRUE(scene.etalon.has_value());
  // A quarter turn about z moves its axis to -X.
  EXPECT_TRUE(scene.etalon->X_WE.position.isApprox(Eigen::Vector3d(0.7, 2, 3)));
}

TEST(SceneMaker, KeepsTheHeightOfALevelScreenDefined) {
  StandConfig stand;
  ScreenConfig floor;
  floor.normal = {0, 2, 0};
  stand.screen = std::vector<ScreenConfig>{floor};
  const Arm arm = arm_of_two();
  const Scene scene = SceneMaker(arm, {}, stand, {}).scene(Backbone(arm, ArmState::straight(2)));
  check(scene);
  EXPECT_TRUE(scene.screens[0].X_WS.rotation.isUnitary(1e-12));
}

}  // namespace
}  // namespace flexura
