#include "flexura/kinematics/spatial.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "flexura/math/quadrature.h"
#include "flexura/math/so3.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

TEST(Spatial, ThePapersArmEndsWhereThePaperSays) {
  const Eigen::Vector3d E = tip_pose(paper_arm(), paper_state()).position;
  EXPECT_NEAR(E.x(), -10.737859, 5e-7);
  EXPECT_NEAR(E.y(), 5.201359, 5e-7);
  EXPECT_EQ(E.z(), 0.0);
}

TEST(Spatial, FramesTipAndBackboneAgree) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const ArmState state = random_state(random, arm);
    const Backbone backbone(arm, state);
    const std::vector<Pose> frames = section_frames(arm, state);
    ASSERT_EQ(frames.size(), arm.sections.size() + 1);
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      EXPECT_LE((frames[i].position - backbone.arcs()[i].X_WS.position).norm(), 1e-14);
    }
    EXPECT_EQ(frames.back().position, tip_pose(arm, state).position);
    const std::vector<double> s = {0.0, 0.4 * backbone.length(), backbone.length()};
    const std::vector<Pose> poses = poses_at(backbone, s);
    EXPECT_EQ(poses[0].position, arm.X_WB.position);
    EXPECT_EQ(poses[1].position, backbone.pose(s[1]).position);
    EXPECT_LE((poses[2].position - frames.back().position).norm(), 1e-14);
  });
}

// An independent way: what turns is only the tangent's direction, in closed form for each arc (sines and
// cosines, no series), and the curve is its integral.
Eigen::Vector3d integrated_tip(const Arm& arm, const ArmState& state) {
  const Quadrature rule = gauss_legendre(20);
  Eigen::Vector3d p = arm.X_WB.position;
  Eigen::Matrix3d R = arm.X_WB.rotation;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const double theta = state.bends[i].norm();
    const double phi = std::atan2(state.bends[i].y(), state.bends[i].x());
    const auto tangent = [&](double fraction) -> Eigen::Vector3d {
      const double angle = fraction * theta;
      return R * Eigen::Vector3d(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi),
                                 std::cos(angle));
    };
    p += arm.sections[i].length * state.stretches[i] * integrate(rule, tangent, 0.0, 1.0, 4);
    R = R * Eigen::AngleAxisd(theta, Eigen::Vector3d(-std::sin(phi), std::cos(phi), 0.0)).toRotationMatrix();
  }
  return p;
}

TEST(Spatial, AgreesWithTheIntegralOfTheTangentTo1em12) {
  EXPECT_LE(
      (integrated_tip(paper_arm(), paper_state()) - tip_pose(paper_arm(), paper_state()).position).norm(),
      1e-12);
  for_random_cases(500, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const ArmState state = random_state(random, arm);
    EXPECT_LE((integrated_tip(arm, state) - tip_pose(arm, state).position).norm(), 1e-12);
  });
}

TEST(Spatial, BendingKeepsTheArmsLength) {
  const Quadrature rule = gauss_legendre(8);
  for_random_cases(50, [&](TestRandom& random) {
    const Arm arm = random_arm(random);
    ArmState state = random_state(random, arm);
    state.stretches.assign(arm.sections.size(), 1.0);
    const Backbone backbone(arm, state);
    // The speed |dp/ds| by differences of positions, integrated inside each arc.
    double length = 0.0;
    for (const Arc& arc : backbone.arcs()) {
      const auto speed = [&](double d) {
        const double h = 2e-4 * arc.length;
        const auto p = [&](double at) { return arc.pose(at).position; };
        return ((8.0 * (p(d + h) - p(d - h)) - (p(d + 2 * h) - p(d - 2 * h))) / (12.0 * h)).norm();
      };
      length += integrate(rule, speed, 0.0, arc.length, 4);
    }
    EXPECT_NEAR(length, arm.length(), 1e-10);
    EXPECT_DOUBLE_EQ(backbone.length(), arm.length());
  });
}

TEST(Spatial, TheTangentIsTheDerivativeAlongTheArm) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Backbone backbone(arm, random_state(random, arm));
    const Arc& arc = backbone.arcs().front();
    const double d = random.uniform(0.1, 0.9) * arc.length;
    const double h = 1e-4 * arc.length;
    const Eigen::Vector3d slope = (arc.pose(d + h).position - arc.pose(d - h).position) / (2 * h);
    EXPECT_LE((slope - arc.pose(d).rotation.col(2)).norm(), 1e-6);
  });
}

TEST(Spatial, RigidMotionsCommute) {
  for_random_cases(200, [](TestRandom& random) {
    Arm arm = random_arm(random);
    const ArmState state = random_state(random, arm);
    const Pose X_VW{so3_exp(random.vector<3>(-3.0, 3.0)), random.vector<3>(-5.0, 5.0)};
    const Pose moved_after = X_VW * tip_pose(arm, state);
    arm.X_WB = X_VW * arm.X_WB;
    const Pose moved_before = tip_pose(arm, state);
    EXPECT_LE((moved_after.position - moved_before.position).norm(), 1e-13);
    EXPECT_LE((moved_after.rotation - moved_before.rotation).norm(), 1e-13);
  });
}

TEST(Spatial, TurningAllBendsTurnsTheArmAboutItsBaseAxis) {
  for_random_cases(200, [](TestRandom& random) {
    Arm arm = random_arm(random);
    arm.X_WB = Pose{};
    ArmState state = random_state(random, arm);
    const double angle = random.uniform(-3.0, 3.0);
    const Eigen::Vector3d expected = so3_exp({0.0, 0.0, angle}) * tip_pose(arm, state).position;
    for (Eigen::Vector2d& bend : state.bends) bend = Eigen::Rotation2Dd(angle) * bend;
    EXPECT_LE((tip_pose(arm, state).position - expected).norm(), 1e-13);
  });
}

TEST(Spatial, MirroredBendsGiveTheMirroredArm) {
  for_random_cases(200, [](TestRandom& random) {
    Arm arm = random_arm(random);
    arm.X_WB = Pose{};
    ArmState state = random_state(random, arm);
    const std::vector<Pose> frames = section_frames(arm, state);
    for (Eigen::Vector2d& bend : state.bends) bend.x() = -bend.x();
    const std::vector<Pose> mirrored = section_frames(arm, state);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(mirrored[i].position.x(), -frames[i].position.x());
      EXPECT_EQ(mirrored[i].position.tail<2>(), frames[i].position.tail<2>());
    }
  });
}

TEST(Spatial, AnArmAndItsReverseAreTheSameCurve) {
  for_random_cases(100, [](TestRandom& random) {
    Arm arm = random_arm(random);
    arm.X_WB = Pose{};
    const ArmState state = random_state(random, arm);
    // From the tip, looking back: z reversed by a half turn about y, sections and bends in reverse order.
    Arm reverse = arm;
    ArmState reverse_state = state;
    const std::size_t n = arm.sections.size();
    for (std::size_t i = 0; i < n; ++i) {
      reverse.sections[i] = arm.sections[n - 1 - i];
      reverse_state.stretches[i] = state.stretches[n - 1 - i];
      reverse_state.bends[i] = {-state.bends[n - 1 - i].x(), state.bends[n - 1 - i].y()};
    }
    const Pose turned{Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal(), Eigen::Vector3d::Zero()};
    reverse.X_WB = tip_pose(arm, state) * turned;
    EXPECT_LE(tip_pose(reverse, reverse_state).position.norm(), 1e-13);
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
