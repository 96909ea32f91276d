#include "flexura/model/backbone.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "flexura/math/so3.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

TEST(Arc, BendsALongRadiusLengthOverBend) {
  // A quarter turn towards +x of radius 2: up 2, across 2, the tangent along x.
  const Pose end = arc_pose({std::numbers::pi / 2, 0.0}, std::numbers::pi);
  EXPECT_LE((end.position - Eigen::Vector3d(2.0, 0.0, 2.0)).norm(), 1e-15);
  EXPECT_LE((end.rotation.col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LE((end.rotation.col(1) - Eigen::Vector3d::UnitY()).norm(), 1e-15);
}

TEST(Arc, IsStraightWithoutBend) {
  const Pose end = arc_pose({0.0, 0.0}, 3.0);
  EXPECT_EQ(end.position, Eigen::Vector3d(0.0, 0.0, 3.0));
  EXPECT_EQ(end.rotation, Eigen::Matrix3d::Identity());
}

TEST(Arc, IsContinuousThroughStraight) {
  for (const double bend : {1e-300, 1e-100, 1e-12, 1e-9}) {
    const Pose end = arc_pose({bend, -2 * bend}, 1.0);
    EXPECT_DOUBLE_EQ(end.position.x(), 0.5 * bend) << bend;
    EXPECT_DOUBLE_EQ(end.position.y(), -bend) << bend;
    EXPECT_DOUBLE_EQ(end.rotation(0, 2), bend) << bend;
  }
}

TEST(Backbone, IsExactAtBothEndsAndWhereSectionsMeet) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Backbone backbone(arm, random_state(random, arm));
    EXPECT_EQ(backbone.pose(0.0).position, arm.X_WB.position);
    EXPECT_EQ(backbone.pose(0.0).rotation, arm.X_WB.rotation);
    EXPECT_EQ(backbone.pose(backbone.length()).position, backbone.tip().position);
    for (const Arc& arc : backbone.arcs()) {
      EXPECT_EQ(backbone.pose(arc.s).position, arc.X_WS.position);
      const Pose just_before = backbone.pose(arc.s * (1.0 - 1e-15));
      EXPECT_LE((just_before.position - arc.X_WS.position).norm(), 1e-14);
      EXPECT_LE((just_before.rotation - arc.X_WS.rotation).norm(), 1e-13);
    }
  });
}

TEST(Backbone, TakesRoundingPastAnEndAsTheEndAndRefusesMore) {
  const Arm arm = paper_arm();
  const Backbone backbone(arm, ArmState::straight(8));
  EXPECT_EQ(backbone.length(), 16.0);
  EXPECT_EQ(backbone.pose(std::nextafter(16.0, 17.0)).position, backbone.tip().position);
  EXPECT_EQ(backbone.pose(-1e-13).position, arm.X_WB.position);
  EXPECT_THROW((void)backbone.pose(16.001), std::out_of_range);
  EXPECT_THROW((void)backbone.pose(-0.001), std::out_of_range);
  EXPECT_THROW((void)backbone.pose(std::numeric_limits<double>::quiet_NaN()), std::out_of_range);
}

TEST(Backbone, StretchesItsSections) {
  ArmState state = ArmState::straight(8);
  state.stretches[0] = 1.5;
  EXPECT_EQ(Backbone(paper_arm(), state).length(), 17.0);
  EXPECT_EQ(Backbone(paper_arm(), state).tip().position, Eigen::Vector3d(0.0, 17.0, 0.0));
}

TEST(Backbone, RefusesWhatDoesNotFit) {
  const Arm arm = paper_arm();
  EXPECT_THROW(Backbone(arm, ArmState::straight(7)), std::invalid_argument);
  EXPECT_THROW(Backbone(Arm{}, ArmState{}), std::invalid_argument);
  ArmState state = ArmState::straight(8);
  state.stretches[3] = 0.0;
  EXPECT_THROW(Backbone(arm, state), std::invalid_argument);
  state = ArmState::straight(8);
  state.bends[2].y() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Backbone(arm, state), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
