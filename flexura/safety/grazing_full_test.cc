// Arms that just miss something, and laws faster than the finest interval.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/safety/motion_check.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

using std::numbers::pi;

Arm thin_arm(std::size_t sections) {
  Arm arm;
  arm.sections.resize(sections);
  for (Section& section : arm.sections) {
    section.length = 0.3;
    section.radius = {0.02, 0.02};
  }
  return arm;
}

ArmState bent(std::size_t sections, double bend) {
  ArmState state = ArmState::straight(sections);
  for (auto& b : state.bends) b.x() = bend;
  return state;
}

SafetyReport check(const Arm& arm, const MotionPtr& motion, const std::vector<ObstacleConfig>& around = {}) {
  return check_motions(arm, obstacles(around), motion->at(0), {{motion, 0}}, 0.02);
}

ObstacleConfig table_at(double z) {
  return PlaneConfig{.name = "table", .point = {0, 0, z}, .normal = {0, 0, 1}};
}

TEST(Grazing, AnArmThatLiesOnATableStaysOnItAndNothingIsLeftUndecided) {
  for (const double gap : {0.0, 1e-7, 1e-4}) {
    const Arm arm = thin_arm(2);
    const auto move = point_to_point_motion(bent(2, 0), bent(2, 1), std::vector(2, Profile::linear(1)));
    const SafetyReport report = check(arm, move, {table_at(-0.02 - gap)});
    EXPECT_TRUE(report.is_safe());
    EXPECT_THAT(report.caveats, IsEmpty());
    const SafetyReport deeper = check(arm, move, {table_at(-0.02 + 2e-6)});
    ASSERT_EQ(deeper.violations.size(), 2u);  // Of both sections.
    for (const Violation& violation : deeper.violations) {
      EXPECT_EQ(violation.start, 0);
      EXPECT_EQ(violation.end, 1);
    }
  }
}

TEST(Grazing, ThePaperArmAboveAPlaneIsDecided) {
  Arm arm = paper_arm();
  for (Section& section : arm.sections) section.radius = {0.1, 0.1};
  const auto move =
      point_to_point_motion(ArmState::straight(8), paper_state(), std::vector(8, Profile::linear(5)));
  const SafetyReport report = check(arm, move, {table_at(-0.1)});
  EXPECT_TRUE(report.is_safe());
  EXPECT_THAT(report.caveats, IsEmpty());
}

TEST(Grazing, WhatStaysTooNearToDecideIsSampledAndSaidSo) {
  const BoxConfig table{.name = "table", .center = {0, 0, -0.07}, .half_sizes = {2, 2, 0.05}};
  const auto move = point_to_point_motion(bent(1, 0), bent(1, 1), {Profile::linear(2)});
  const SafetyReport report = check(thin_arm(1), move, {table});
  EXPECT_TRUE(report.is_safe());
  EXPECT_THAT(report.caveats, ElementsAre(StartsWith("contact with table undecided, 0 s to 2 s: ")));
}

TEST(Grazing, ABendThatGoesRoundAtItsMaximumIsSampled) {
  Arm arm = thin_arm(1);
  arm.kind = ArmKind::spatial;
  arm.sections[0].max_bend = 1;
  std::vector<double> times;
  std::vector<ArmState> round;
  for (int k = 0; k <= 40; ++k) {
    times.push_back(k * 0.25);
    const double angle = 2 * pi * k / 40;
    round.push_back({{{0.99999999 * std::cos(angle), 0.99999999 * std::sin(angle)}}, {1}});
  }
  const SafetyReport report = check(arm, keyframe_motion(times, round, Interpolation::smooth));
  EXPECT_THAT(report.caveats, ElementsAre(StartsWith("section 1: bend undecided, ")));
}

TEST(Grazing, KeyframesAMomentApartJump) {
  Arm arm = thin_arm(1);
  arm.sections[0].max_bend_rate = 20 * degree;
  const auto rows = keyframe_motion(
      {0, 1, 1.00000001, 3}, {bent(1, 0), bent(1, 0.1), bent(1, 0.5), bent(1, 0.6)}, Interpolation::linear);
  const SafetyReport report = check(arm, rows);
  ASSERT_EQ(report.violations.size(), 2u);
  EXPECT_EQ(report.violations[0].hazard, Hazard::bend_rate);
  EXPECT_EQ(report.violations[1].hazard, Hazard::jump);
  EXPECT_NEAR(report.violations[1].start, 1, 1e-7);  // To the precision of spans of limits.
  EXPECT_NEAR(report.violations[1].value, 0.4, 1e-6);
}

TEST(Grazing, ASweepThroughAnObstacleInAMomentIsAContact) {
  const Arm arm = thin_arm(1);
  const SphereConfig ball{.name = "ball", .center = {0.09, 0.27, 0}, .radius = 0.005};
  const auto rows =
      keyframe_motion({0, 1, 1.00001, 1.00002, 2},
                      {bent(1, 0), bent(1, 0), bent(1, 0.7), bent(1, 0), bent(1, 0)}, Interpolation::linear);
  const SafetyReport report = check(arm, rows, {ball});
  EXPECT_TRUE(std::ranges::any_of(report.violations, [](const Violation& violation) {
    return violation.hazard == Hazard::obstacle && std::abs(violation.start - 1) < 1e-4;
  }));
}

}  // namespace
}  // namespace flexura
