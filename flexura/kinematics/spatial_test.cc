#include "flexura/kinematics/spatial.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "flexura/math/quadrature.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

TEST(Spatial, FramesTipAndBackboneAreOneArm) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const ArmState state = random_state(random, arm);
    const Backbone backbone(arm, state);
    std::vector<Pose> frames(arm.sections.size() + 1);
    section_frames(arm, state, frames);
    for (std::size_t i = 0; i < arm.sections.size(); ++i)
      EXPECT_EQ(frames[i].position, backbone.arcs()[i].X_WS.position);
    EXPECT_EQ(frames.back().position, backbone.tip().position);
    EXPECT_EQ(frames.back().position, tip_pose(arm, state).position);
    EXPECT_EQ(frames.back().rotation, tip_pose(arm, state).rotation);
  });
}

// Independent computation: only the tangent's direction turns, in closed form for each arc (sines and
// cosines, no series), and the curve is its integral. Returns the pose at a fraction of the last section.
Pose integrated_pose(const Arm& arm, const ArmState& state, double last_fraction) {
  const Quadrature rule = gauss_legendre(20);
  Eigen::Vector3d p = arm.X_WB.position;
  Eigen::Matrix3d R = arm.X_WB.rotation;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const double part = i + 1 < arm.sections.size() ? 1.0 : last_fraction;
    const double theta = state.bends[i].norm();
    const double phi = std::atan2(state.bends[i].y(), state.bends[i].x());
    const auto tangent = [&](double fraction) -> Eigen::Vector3d {
      const double angle = fraction * theta;
      return R * Eigen::Vector3d(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi),
                                 std::cos(angle));
    };
    p += arm.sections[i].length * state.stretches[i] * integrate(rule, tangent, 0.0, part, 4);
    R = R * Eigen::AngleAxisd(part * theta, Eigen::Vector3d(-std::sin(phi), std::cos(phi), 0.0))
                .toRotationMatrix();
  }
  return {R, p};
}

TEST(Spatial, AgreesWithTheIntegralOfTheTangentTo1em12) {
  EXPECT_LE((integrated_pose(paper_arm(), paper_state(), 1.0).position -
             tip_pose(paper_arm(), paper_state()).position)
                .norm(),
            1e-12);
  for_random_cases(500, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const ArmState state = random_state(random, arm);
    const Pose tip = integrated_pose(arm, state, 1.0);
    EXPECT_LE((tip.position - tip_pose(arm, state).position).norm(), 1e-12);
    EXPECT_LE((tip.rotation - tip_pose(arm, state).rotation).norm(), 1e-12);
    const double fraction = random.uniform(0.0, 1.0);
    const Pose inside = integrated_pose(arm, state, fraction);
    const Arc last = Backbone(arm, state).arcs().back();
    EXPECT_LE((inside.position - last.pose(fraction * last.length).position).norm(), 1e-12);
    EXPECT_LE((inside.rotation - last.pose(fraction * last.length).rotation).norm(), 1e-12);
  });
}

TEST(Spatial, MaterialPointsStayWithTheirSection) {
  const Arm arm = paper_arm();
  ArmState state = ArmState::straight(8);
  state.stretches[0] = 2.0;
  const MaterialPoint point = material_point(arm, 3.5);
  EXPECT_EQ(point.section, 1u);
  EXPECT_DOUBLE_EQ(point.fraction, 0.5);
  EXPECT_DOUBLE_EQ(arc_length_of(arm, state, point), 5.5);
  EXPECT_EQ(material_point(arm, 2.0).section, 0u);
  EXPECT_EQ(material_point(arm, 2.0).fraction, 1.0);
  EXPECT_EQ(material_point(arm, 0.0).fraction, 0.0);
  EXPECT_EQ(material_point(arm, std::nextafter(16.0, 17.0)).section, 7u);
  EXPECT_EQ(material_point(arm, std::nextafter(16.0, 17.0)).fraction, 1.0);
  EXPECT_THROW((void)material_point(arm, 16.1), std::out_of_range);
}

TEST(Spatial, WhereSectionsMeetTheMaterialPointIsExactlyTheFirstOnesEnd) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    double s = 0.0;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      s += arm.sections[i].length;
      EXPECT_EQ(material_point(arm, s).section, i);
      EXPECT_EQ(material_point(arm, s).fraction, 1.0);
    }
  });
}

TEST(Spatial, RefusesWhatDoesNotFit) {
  std::vector<Pose> frames(8);
  EXPECT_THROW(section_frames(paper_arm(), paper_state(), frames), std::invalid_argument);
  EXPECT_THROW((void)tip_pose(paper_arm(), ArmState::straight(3)), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
