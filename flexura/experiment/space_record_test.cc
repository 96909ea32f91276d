#include "flexura/experiment/space_record.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexura {
namespace {

Arm straight_arm() {
  Arm arm;
  arm.sections.resize(2);
  return arm;
}

Backbone bent(double bend) {
  ArmState state = ArmState::straight(2);
  state.bends[0].x() = bend;
  return {straight_arm(), state};
}

Experiment with_camera() {
  Experiment experiment;
  experiment.arm.section.resize(1);
  CameraConfig camera;
  camera.name = "front";
  camera.mount.position = {0, 0, 2};
  camera.mount.look_at = {0, 0, 0};
  experiment.camera = {camera};
  return experiment;
}

TEST(SpaceRecord, HasNoTrueArmThatNobodyCanTellFromTheCommandedOne) {
  SpaceRecord record;
  for (int i = 0; i < 10; ++i) record.true_arm(i, bent(0.1 + 1e-4), bent(0.1));
  EXPECT_TRUE(std::move(record).space().true_arms.empty());
}

TEST(SpaceRecord, ThinsTrueArmsEvenlyAndKeepsTheFirstAndTheLast) {
  SpaceRecord record;
  const Backbone straight = bent(0);
  for (int i = 0; i <= 10'000; ++i) record.true_arm(0.01 * i, bent(1e-5 * i), straight);
  const std::vector<ReportSpace::TrueArm> arms = std::move(record).space().true_arms;
  ASSERT_GT(arms.size(), 100U);
  EXPECT_LE(arms.size(), 241U);
  EXPECT_EQ(arms.front().time, 0);
  EXPECT_EQ(arms.back().time, 100);
  const double step = arms[1].time;
  for (std::size_t i = 1; i + 1 < arms.size(); ++i) {
    EXPECT_NEAR(arms[i].time - arms[i - 1].time, step, 1e-9);
    EXPECT_EQ(arms[i].points.size(), arms[0].points.size());
  }
}

TEST(SpaceRecord, HasACameraWhereItsAxesMove) {
  SpaceRecord record;
  record.add_cameras(with_camera());
  ASSERT_NE(record.first_report("front"), nullptr);
  EXPECT_EQ(record.first_report("side"), nullptr);
  CameraStance stance = *record.first_report("front");
  record.report(1, "front", stance);  // Has not moved.
  stance.head.pan += 0.2;
  record.report(2, "front", stance);
  const std::vector<ReportSpace::Camera> cameras = std::move(record).space().cameras;
  ASSERT_EQ(cameras.size(), 1U);
  ASSERT_EQ(cameras[0].views.size(), 2U);
  EXPECT_EQ(cameras[0].views[1].time, 2);
  const Eigen::Vector3d before = cameras[0].views[0].X_WC.rotation.col(2),
                        after = cameras[0].views[1].X_WC.rotation.col(2);
  EXPECT_NEAR(std::acos(before.dot(after)), 0.2, 1e-6);
  const auto [left, right, top, bottom] = cameras[0].views[0].window;
  EXPECT_LT(left, 0);
  EXPECT_NEAR(right, -left, 0.01);
  EXPECT_NEAR(bottom, -top, 0.01);
}

TEST(SpaceRecord, KeepsTheNewestOfManyViews) {
  SpaceRecord record;
  record.add_cameras(with_camera());
  CameraStance stance = *record.first_report("front");
  for (int i = 1; i <= 3000; ++i) {
    stance.head.pan = 1e-4 * i;
    record.report(i, "front", stance);
  }
  const std::vector<ReportSpace::Camera> cameras = std::move(record).space().cameras;
  EXPECT_LE(cameras[0].views.size(), 401U);
  EXPECT_EQ(cameras[0].views.back().time, 3000);
}

}  // namespace
}  // namespace flexura
