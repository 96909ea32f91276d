#include "flexura/calibrate/arc_plan.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "flexura/model/backbone.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Arm three_sections() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (const double length : {0.35, 0.35, 0.3}) {
    Section& section = arm.sections.emplace_back();
    section.length = length, section.max_bend = 2;
  }
  return arm;
}

TEST(ArcState, IsOneArcOfACircleInItsPlane) {
  const Arm arm = three_sections();
  for_random_cases(100, [&](TestRandom& random) {
    const double bend = random.uniform(0.3, 4), way = random.uniform(-3, 3);
    const Eigen::Vector3d towards(std::cos(way), 0, std::sin(way));
    const auto state = arc_state(arm, bend, towards);
    ASSERT_TRUE(state);
    const Backbone backbone(arm, *state);
    const double radius = arm.length() / bend;
    const Eigen::Vector3d center = radius * towards;
    for (int i = 0; i <= 20; ++i) {
      const Eigen::Vector3d p = backbone.pose(arm.length() * i / 20).position;
      EXPECT_NEAR((p - center).norm(), radius, 1e-12);
      EXPECT_NEAR(p.dot(towards.cross(Eigen::Vector3d::UnitY())), 0, 1e-12);
    }
  });
}

TEST(ArcState, IsNoneWhereTheArmCannot) {
  Arm arm = three_sections();
  EXPECT_FALSE(arc_state(arm, 6.1, Eigen::Vector3d::UnitX()));  // A section bends by 2 rad at most.
  EXPECT_FALSE(arc_state(arm, 1, Eigen::Vector3d::UnitY()));
  arm.kind = ArmKind::planar;
  EXPECT_TRUE(arc_state(arm, 1, Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(arc_state(arm, 1, Eigen::Vector3d::UnitZ()));
}

}  // namespace
}  // namespace flexura
