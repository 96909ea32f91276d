#include "flexura/model/backbone.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

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

TEST(Backbone, KnowsWhereItsMaterialLies) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Backbone backbone(arm, random_state(random, arm));
    EXPECT_NEAR(backbone.rest_length(), arm.length(), 1e-14 * arm.length());
    double s_rest = 0;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const Arc& arc = backbone.arcs()[i];
      EXPECT_EQ(arc.section, i);
      EXPECT_EQ(arc.radius, arm.sections[i].radius);
      const double share = random.uniform(0.01, 0.99);
      const double at = s_rest + share * arm.sections[i].length;
      EXPECT_NEAR(backbone.s_at_rest(at), arc.s + share * arc.length, 1e-12 * backbone.length());
      EXPECT_NEAR(backbone.s_rest_at(backbone.s_at_rest(at)), at, 1e-12 * arm.length());
      s_rest += arm.sections[i].length;
    }
    EXPECT_EQ(backbone.s_at_rest(-1), 0);
    EXPECT_EQ(backbone.s_at_rest(2 * arm.length()), backbone.length());
    EXPECT_EQ(backbone.s_rest_at(-1), 0);
    EXPECT_NEAR(backbone.s_rest_at(2 * backbone.length()), arm.length(), 1e-14 * arm.length());
  });
}

TEST(Backbone, ThroughSamplesOfAnArcIsTheArc) {
  for_random_cases(50, [](TestRandom& random) {
    Arm arm = random_arm(random);
    arm.sections.resize(1);
    ArmState state = random_state(random, arm);
    state.bends[0] *= std::min(1.0, 3 / state.bends[0].norm());  // Two arcs cannot turn back by more.
    const Backbone arc(arm, state);
    const auto sample = [&](double share) {
      const auto [from, to] = arm.sections[0].radius;
      return BackboneSample{arc.pose(share * arc.length()), share * arm.length(), from + share * (to - from),
                            0};
    };
    const Backbone through = Backbone::through(std::vector{sample(0), sample(0.4), sample(1)});
    ASSERT_EQ(through.arcs().size(), 4U);
    EXPECT_NEAR(through.length(), arc.length(), 1e-12 * arc.length());
    for (double share = 0; share <= 1; share += 0.05) {
      const Pose is = through.pose(share * through.length()), shall = arc.pose(share * arc.length());
      EXPECT_LE((is.position - shall.position).norm(), 1e-11 * arc.length()) << share;
      EXPECT_LE((is.rotation - shall.rotation).norm(), 1e-10) << share;
      EXPECT_NEAR(through.s_at_rest(share * arm.length()), share * arc.length(), 1e-11 * arc.length());
    }
  });
}

// A helix about z of radius a that climbs by 2 pi b per turn. The x axis of its frame points to the helix's
// axis, so the frame rotates about the tangent.
Pose helix(double a, double b, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), l = std::hypot(a, b);
  const Eigen::Vector3d tangent(-a * s / l, a * c / l, b / l), x(-c, -s, 0);
  Pose X;
  X.position = {a * c, a * s, b * angle};
  X.rotation << x, tangent.cross(x), tangent;
  return X;
}

TEST(Backbone, ThroughSamplesOfAHelixConvergesToItInPlaceAndTurn) {
  constexpr double a = 0.3, b = 0.1, turns = 4;  // rad.
  double off_before = 0, turn_before = 0;
  for (const int count : {4, 8, 16, 32}) {
    std::vector<BackboneSample> samples;
    for (int i = 0; i <= count; ++i)
      samples.push_back({helix(a, b, turns * i / count), static_cast<double>(i), 0.02, 0});
    const Backbone backbone = Backbone::through(samples);
    double off = 0, turn = 0;
    for (int i = 0; i < count; ++i) {
      // Exactly through the samples, with the material's frame.
      const Pose at = backbone.arcs()[2 * static_cast<std::size_t>(i)].X_WS;
      EXPECT_LE((at.position - samples[static_cast<std::size_t>(i)].X_WS.position).norm(), 1e-14);
      EXPECT_LE((at.rotation - samples[static_cast<std::size_t>(i)].X_WS.rotation).norm(), 1e-12);
      // Near the curve between the samples.
      const Pose middle = backbone.pose(backbone.s_at_rest(i + 0.5));
      const Pose shall = helix(a, b, turns * (i + 0.5) / count);
      off = std::max(off, (middle.position - shall.position).norm());
      turn = std::max(turn, (middle.rotation - shall.rotation).norm());
    }
    EXPECT_NEAR(backbone.length(), turns * std::hypot(a, b), 2.0 / (count * count));
    if (off_before > 0) {
      EXPECT_LT(off, off_before / 6) << count;
      EXPECT_LT(turn, turn_before / 3) << count;
    }
    off_before = off, turn_before = turn;
  }
  EXPECT_LT(off_before, 1e-4);
}

TEST(Backbone, ThroughSamplesRefusesWhatIsNoCurve) {
  const auto at = [](double z, double s_rest) {
    Pose X;
    X.position.z() = z;
    return BackboneSample{X, s_rest, 0.02, 0};
  };
  const auto refuses = [](std::vector<BackboneSample> samples) {
    EXPECT_THROW((void)Backbone::through(samples), std::invalid_argument);
  };
  EXPECT_NO_THROW((void)Backbone::through(std::vector{at(0, 0), at(1, 1)}));
  refuses({});
  refuses({at(0, 0)});
  refuses({at(0, 0), at(0, 1)});
  refuses({at(0, 0), at(1, 0)});
  refuses({at(1, 0), at(0, 1)});
  refuses({at(0, 0), at(std::numeric_limits<double>::quiet_NaN(), 1)});
  BackboneSample thin = at(1, 1);
  thin.radius = 0;
  refuses({at(0, 0), thin});
}

}  // namespace
}  // namespace flexura
