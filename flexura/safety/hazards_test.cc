// Every hazard must be found just beyond its limit, and not just within it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

using std::numbers::pi;

Arm thin_section() {
  Arm arm;
  arm.sections.resize(1);
  return arm;
}

ArmState state(double bend, double stretch = 1) { return {{{bend, 0}}, {stretch}}; }

SafetyReport check_among(const Arm& arm, const MotionPtr& motion,
                         const std::vector<ObstacleConfig>& around = {}) {
  return check_motions(arm, obstacles(around), motion->at(0), {{motion, 0}}, 0.02);
}

// Requests reports with a value at `part` of its limit.
void expect_just(Hazard hazard, const std::function<SafetyReport(double part)>& report_at) {
  const SafetyReport within = report_at(1 - 1e-5);
  EXPECT_TRUE(within.is_safe()) << within.violations.front().text();
  const SafetyReport beyond = report_at(1 + 1e-5);
  ASSERT_EQ(beyond.violations.size(), 1U);
  EXPECT_EQ(beyond.violations[0].hazard, hazard) << beyond.violations[0].text();
}

TEST(Hazard, Bend) {
  Arm arm = thin_section();
  arm.sections[0].max_bend = 1;
  expect_just(Hazard::bend, [&](double part) {
    return check_among(arm, point_to_point_motion(state(0), state(part), {Profile::minimum_jerk(3)}));
  });
  // A peak far shorter than a clock step.
  expect_just(Hazard::bend, [&](double part) {
    return check_among(arm, sine_motion(state(0), {{part, 0}}, {0}, 0.011, 0.005));
  });
}

TEST(Hazard, StretchRate) {
  Arm arm = thin_section();
  arm.sections[0].stretch_limits = {0.5, 2}, arm.sections[0].max_stretch_rate = 0.3;
  const auto stretched = [](double stretch) {
    ArmState one = state(0);
    one.stretches[0] = stretch;
    return one;
  };
  expect_just(Hazard::stretch_rate, [&](double part) {
    return check_among(arm,
                       keyframe_motion({0, 1, 2}, {stretched(1), stretched(1.1), stretched(1.1 + 0.3 * part)},
                                       Interpolation::linear));
  });
  // A law without bounds on its rates, which is sampled.
  expect_just(Hazard::stretch_rate, [&](double part) {
    return check_among(arm,
                       function_motion(1, [&, part](double t) { return stretched(1 + 0.3 * part * t); }));
  });
}

TEST(Hazard, BendRate) {
  Arm arm = thin_section();
  arm.sections[0].max_bend_rate = 2;
  expect_just(Hazard::bend_rate, [&](double part) {
    return check_among(arm, sine_motion(state(0), {{part / pi, 0}}, {pi / 2}, 1, 0.6));
  });
  expect_just(Hazard::bend_rate, [&](double part) {
    return check_among(
        arm, keyframe_motion({0, 1, 2}, {state(0), state(1), state(1 + 2 * part)}, Interpolation::linear));
  });
}

TEST(Hazard, Stretch) {
  Arm arm = thin_section();
  arm.sections[0].stretch_limits = {0.8, 1.2};
  for (const double limit : arm.sections[0].stretch_limits) {
    expect_just(Hazard::stretch, [&](double part) {
      const double to = 1 + part * (limit - 1);
      return check_among(arm, point_to_point_motion(state(0), state(0, to), {Profile::linear(1)}));
    });
  }
}

TEST(Hazard, Folding) {
  Arm arm = thin_section();
  arm.sections[0].radius = {0.1, 0.4};
  expect_just(Hazard::folding, [&](double part) {
    return check_among(arm, point_to_point_motion(state(0), state(2.5 * part), {Profile::linear(1)}));
  });
}

TEST(Hazard, FormulaWithoutAValue) {
  expect_just(Hazard::not_finite, [&](double part) {
    return check_among(thin_section(),
                       function_motion(1, [part](double t) { return state(std::sqrt(1 - part * t)); }));
  });
}

// Four sections of 1 m that bend by 1.5 rad each: their ends come to 2 sin(3)/1.5 m from each other.
TEST(Hazard, SelfContact) {
  Arm arm;
  arm.sections.resize(4);
  ArmState curled = ArmState::straight(4);
  for (auto& bend : curled.bends) bend.x() = 1.5;
  expect_just(Hazard::self_contact, [&](double part) {
    const double radius = part * std::sin(3) / 1.5;
    for (Section& section : arm.sections) section.radius = {radius, radius};
    return check_among(
        arm, point_to_point_motion(ArmState::straight(4), curled, std::vector(4, Profile::linear(2))));
  });
}

// The straight arm stands on the origin along +Y; its tip's ball reaches 1.02 m.
TEST(Hazard, Obstacles) {
  const Arm arm = thin_section();
  const MotionPtr stand = hold_motion(state(0), 1);
  const double r = 0.02;
  expect_just(Hazard::obstacle, [&](double part) {
    return check_among(arm, stand, {PlaneConfig{.point = {0, 1.02 / part, 0}, .normal = {0, -3, 0}}});
  });
  expect_just(Hazard::obstacle, [&](double part) {
    return check_among(arm, stand, {SphereConfig{.center = {0.3, 0.5, 0.4}, .radius = part * 0.5 - r}});
  });
  expect_just(Hazard::obstacle, [&](double part) {
    return check_among(
        arm, stand, {CapsuleConfig{.from = {-1, 0.4, 0.3}, .to = {1, 0.4, 0.3}, .radius = part * 0.3 - r}});
  });
  // Turned by 45 degrees about Z, so that its edge points at the arm.
  expect_just(Hazard::obstacle, [&](double part) {
    return check_among(arm, stand,
                       {BoxConfig{.center = {0.5, 0.5, 0},
                                  .half_sizes = {(part * 0.5 - r) / std::numbers::sqrt2,
                                                 (part * 0.5 - r) / std::numbers::sqrt2, 1},
                                  .rotation = {std::cos(pi / 8), 0, 0, std::sin(pi / 8)}}});
  });
}

// The tip swings out by 1 - cos 1 m and back between two clock steps.
TEST(Hazard, ObstacleTouchedBetweenTwoSteps) {
  const MotionPtr swing = sine_motion(state(0), {{1, 0}}, {0}, 0.036, 0.018);
  const double farthest = 1 - std::cos(1.0) + 0.02;
  const auto wall = [&](double at) { return PlaneConfig{.point = {at, 0, 0}, .normal = {-1, 0, 0}}; };
  EXPECT_TRUE(check_among(thin_section(), swing, {wall(farthest + 1e-5)}).is_safe());
  const SafetyReport report = check_among(thin_section(), swing, {wall(farthest - 1e-3)});
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_NEAR(report.violations[0].value, 1e-3, 1e-5);
}

}  // namespace
}  // namespace flexura
