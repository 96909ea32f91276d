#include "flexura/safety/drive_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

constexpr double step = 0.01;  // Step of the command list, s.
constexpr std::int64_t fine_steps = 100'000'000;
constexpr std::int64_t fine_microsteps = 1000;

// One planar section of 0.5 m with a tendon on either side, 20 mm from the backbone. Spools of 10 mm are
// behind gears of 5 to 1. A bend of 1 rad takes 20 mm of cable, 2 rad of the spool and 10 rad of the motor.
// The microsteps are so small that rounding is negligible, unless a test makes them larger.
class DriveCheck : public ::testing::Test {
 protected:
  DriveCheck() {
    arm_.sections.resize(1);
    arm_.sections[0].length = 0.5;
    for (const double angle : {0.0, std::numbers::pi}) {
      drive_.tendons.push_back({0, 0.02, angle});
      drive_.axes.push_back({.motor = {.steps = fine_steps, .microsteps = fine_microsteps},
                             .spool = {.radius = 0.01, .gear = 5},
                             .reversed = angle > 0});
    }
  }
  SafetyReport check(const MotionPtr& motion) const {
    std::vector<double> times;
    const auto steps = static_cast<int>(std::lround(motion->duration() / step));
    for (int k = 0; k <= steps; ++k) times.push_back(motion->duration() * k / steps);
    return check(motion, times);
  }
  SafetyReport check(const MotionPtr& motion, const std::vector<double>& times) const {
    SafetyReport report;
    const auto rates = [&](double a, double b) -> std::optional<std::vector<SectionRates>> {
      const auto known = motion->rates(0, a, b);
      if (!known) return std::nullopt;
      return std::vector{*known};
    };
    check_drive(arm_, drive_, [&](double t) { return motion->at(t); }, times, rates, report);
    report.sort();
    return report;
  }
  // Checks a linear motion from straight to a bend within 1 s.
  SafetyReport check_bend(double bend) const {
    return check(point_to_point_motion(state(0), state(bend), {Profile::linear(1)}));
  }
  static ArmState state(double bend) { return {{{bend, 0}}, {1}}; }
  // Sets a limit of the first motor and expects that a bend breaks it just above 1 rad.
  void expect_limit(double StepperMotor::* limit, double value, Hazard hazard) {
    drive_.axes[0].motor.*limit = value;
    EXPECT_TRUE(check_bend(1 - 1e-6).is_safe());
    const SafetyReport beyond = check_bend(1 + 1e-6);
    ASSERT_FALSE(beyond.is_safe());
    for (const Violation& violation : beyond.violations) {
      EXPECT_EQ(violation.hazard, hazard);
      EXPECT_EQ(violation.name, "1.1");
      EXPECT_EQ(violation.limit, value);
      EXPECT_NEAR(violation.value, value * (1 + 1e-6), value * 1e-8);
    }
    drive_.axes[0].motor.*limit = std::numeric_limits<double>::infinity();
  }

  Arm arm_;
  Drive drive_;
};

TEST_F(DriveCheck, FindsEveryLimitJustBeyondItAndNotJustWithin) {
  const double microsteps = 10 / (2 * std::numbers::pi) * fine_steps * fine_microsteps;
  expect_limit(&StepperMotor::max_speed, 10, Hazard::motor_speed);
  expect_limit(&StepperMotor::max_step_rate, microsteps, Hazard::step_rate);
  expect_limit(&StepperMotor::max_position, microsteps, Hazard::motor_position);
  // From rest to 10 rad/s within a step.
  expect_limit(&StepperMotor::max_acceleration, 10 / step, Hazard::motor_acceleration);
}

TEST_F(DriveCheck, TellsWhenAndHowMuch) {
  drive_.axes[1].motor.max_speed = 5;
  const auto law =
      keyframe_motion({0, 1, 2, 3}, {state(0), state(0.1), state(0.9), state(1)}, Interpolation::linear);
  const SafetyReport report = check(law);
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_EQ(report.violations[0].section, 0U) << "the one that the motor bends";
  EXPECT_EQ(report.violations[0].text(),
            "1 s to 2 s: axis 1.2: motor speed 458.366 deg/s, limit 286.479 deg/s");
}

TEST_F(DriveCheck, SaysWhereALawMayBeTooFastBetweenTwoStepsAndOnlyThere) {
  // The bend swings by 0.1 rad with the period of the step: every row has the same state.
  const auto slips = sine_motion(state(0), {{0.1, 0}}, {0}, step, 1);
  drive_.axes[0].motor.max_speed = 10;
  const SafetyReport slipped = check(slips);
  EXPECT_TRUE(slipped.is_safe()) << "of the command list, which is what the motors follow";
  ASSERT_EQ(slipped.caveats.size(), 1U);
  EXPECT_EQ(
      slipped.caveats[0],
      "motor speed and step rate of 1.1: sampled every 0.01 s; the motion may be faster between two samples");
  // For a bend of 1 rad the motor turns by 10 rad. A minimum-jerk motion of 1 s has at most 1.875 rad/s of
  // bend.
  const auto smooth = point_to_point_motion(state(0), state(1), {Profile::minimum_jerk(1)});
  drive_.axes[0].motor.max_speed = 18.75 * (1 + 1e-6);
  EXPECT_TRUE(check(smooth).caveats.empty()) << "proven by the law's own rates";
  drive_.axes[0].motor.max_speed = 18.75 * (1 - 1e-6);
  const SafetyReport peak = check(smooth);  // No row detects the peak: the mean from row to row is less.
  EXPECT_TRUE(peak.is_safe());
  EXPECT_EQ(peak.caveats.size(), 1U);
  drive_.axes[0].motor.max_speed = 15;
  EXPECT_FALSE(check(smooth).is_safe());
  EXPECT_TRUE(check(smooth).caveats.empty()) << "told as a violation";
  // A formula has no known rates.
  drive_.axes[0].motor.max_speed = 1e3;
  const SafetyReport formula = check(function_motion(1, [](double t) { return state(0.1 * t); }));
  EXPECT_TRUE(formula.is_safe());
  EXPECT_EQ(formula.caveats.size(), 1U);
  drive_.axes[0].motor.max_speed = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(check(slips).caveats.empty()) << "without a limit there is nothing to break";
}

TEST_F(DriveCheck, AnEvenMoveIsTooSuddenWhereItStartsAndEnds) {
  drive_.axes[0].motor.max_acceleration = 500;
  const SafetyReport report = check_bend(1);
  ASSERT_EQ(report.violations.size(), 2U);
  ASSERT_EQ(report.caveats.size(), 1U);
  EXPECT_NE(report.caveats[0].find("the next, 0.01 s; "), std::string::npos) << report.caveats[0];
  EXPECT_EQ(report.violations[0].start, 0);
  EXPECT_EQ(report.violations[1].start, 1);
  // The minimum-jerk motion has an acceleration of up to 10/sqrt(3) of the way per second squared.
  const auto smooth = point_to_point_motion(state(0), state(1), {Profile::minimum_jerk(1)});
  drive_.axes[0].motor.max_acceleration = 10 * 10 / std::numbers::sqrt3;
  EXPECT_TRUE(check(smooth).is_safe());
  drive_.axes[0].motor.max_acceleration *= 0.99;
  EXPECT_FALSE(check(smooth).is_safe());
}

TEST_F(DriveCheck, PlayIsTakenUpAtOnceAndCounts) {
  drive_.axes[0].spool.backlash = 0.02;  // 0.1 rad of the motor: 10 rad/s within a step.
  drive_.axes[0].motor.max_speed = 12;
  const auto there_and_back = keyframe_motion({0, 1, 2}, {state(0), state(0.3), state(0)},
                                              Interpolation::linear);  // 3 rad/s of the motor.
  const SafetyReport report = check(there_and_back);
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_NEAR(report.violations[0].start, 1, 1e-12);
  EXPECT_NEAR(report.violations[0].end, 1 + step, 1e-12);
  EXPECT_NEAR(report.violations[0].value, 13, 1e-7);
  ASSERT_EQ(report.caveats.size(), 1U);
  EXPECT_EQ(report.caveats[0],
            "motors of 1.1: when a tendon reverses, its backlash is compensated within one clock step, "
            "0.01 s; a shorter step requires a higher speed and acceleration");
  // A motion that is too fast throughout, with or without backlash, needs no caveat.
  drive_.axes[0].motor.max_speed = 2;
  drive_.axes[0].spool.backlash = 0;
  EXPECT_TRUE(check(there_and_back).caveats.empty());
  drive_.axes[0].motor.max_speed = 12;
  EXPECT_TRUE(check(there_and_back).is_safe()) << "without play there is nothing to take up";
}

TEST_F(DriveCheck, JudgesTheListAsItIsRounded) {
  drive_.axes[0].motor.steps = 100;
  drive_.axes[0].motor.microsteps = 1;  // 1.5915 per row, rounded to 1 and 2.
  drive_.axes[0].motor.max_step_rate = 2 / step;
  EXPECT_TRUE(check_bend(1).is_safe());
  EXPECT_TRUE(check_bend(1).caveats.empty());
  drive_.axes[0].motor.max_step_rate = 1.99 / step;
  const SafetyReport rounded = check_bend(1);
  ASSERT_FALSE(rounded.is_safe());
  for (const Violation& violation : rounded.violations) {
    EXPECT_EQ(violation.hazard, Hazard::step_rate);
    EXPECT_NEAR(violation.value, 2 / step, 1e-9);
  }
  ASSERT_EQ(rounded.caveats.size(), 1U);
  EXPECT_EQ(
      rounded.caveats[0],
      "motor speed and step rate of 1.1: the motion is within the limit, but exceeds it after rounding, "
      "by up to one microstep in 0.01 s");
  drive_.axes[0].motor.max_step_rate = 1.5 / step;
  EXPECT_TRUE(check_bend(1).caveats.empty()) << "too fast without any rounding";
  // 159.15 microsteps in all, of which the list counts 159.
  drive_.axes[0].motor.max_step_rate = std::numeric_limits<double>::infinity();
  drive_.axes[0].motor.max_position = 159;
  EXPECT_TRUE(check_bend(1).is_safe());
  drive_.axes[0].motor.max_position = 158.9;
  EXPECT_FALSE(check_bend(1).is_safe());
}

TEST_F(DriveCheck, LetsSingleMicrostepsPassWhereARowIsTooShortForOne) {
  drive_.axes[0].motor.steps = 30;
  drive_.axes[0].motor.microsteps = 1;              // 0.477 per row: rounded to 0 or 1.
  drive_.axes[0].motor.max_step_rate = 0.6 / step;  // Less than one per row.
  const SafetyReport slow = check_bend(1);
  EXPECT_TRUE(slow.is_safe());
  ASSERT_EQ(slow.caveats.size(), 1U);
  EXPECT_EQ(
      slow.caveats[0],
      "motor speed and step rate of 1.1: a single microstep in a clock step of 0.01 s already exceeds the "
      "limit. The motion is accepted if it is within the limit before rounding");
  EXPECT_FALSE(check_bend(1.3).is_safe()) << "0.62 a row";
  drive_.axes[0].motor.max_step_rate = 1 / step;
  EXPECT_TRUE(check_bend(1).caveats.empty()) << "one a row is within the limit";
}

TEST_F(DriveCheck, TheLastStepOfARunMayBeShort) {
  drive_.axes[0].motor.max_acceleration = 10 / step * (1 + 1e-6);
  const double end = 1 + step / 100;  // Not a whole number of steps.
  const auto even = point_to_point_motion(state(0), state(end), {Profile::linear(end)});
  std::vector<double> times;
  for (int k = 0; k <= 100; ++k) times.push_back(k * step);
  times.push_back(end);
  EXPECT_TRUE(check(even, times).is_safe()) << "stops within a whole step, as it would after another";
  drive_.axes[0].motor.max_acceleration = 10 / step * (1 - 1e-6);
  EXPECT_EQ(check(even, times).violations.size(), 2U);
}

TEST_F(DriveCheck, RoundingToMicrostepsIsNoAcceleration) {
  drive_.axes[0].motor.steps = 3;
  drive_.axes[0].motor.microsteps = 1;  // 2 rad each.
  drive_.axes[0].motor.max_acceleration = 10 * 10 / std::numbers::sqrt3;
  EXPECT_TRUE(check(point_to_point_motion(state(0), state(1), {Profile::minimum_jerk(1)})).is_safe());
}

TEST_F(DriveCheck, EndsBeforeAStateThatIsNotPossible) {
  drive_.axes[0].motor.max_speed = 1e-3;
  const auto nowhere = function_motion(1, [](double t) { return state(std::sqrt(0.5 - t)); });
  const SafetyReport report = check(nowhere);
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_EQ(report.violations[0].end, 0.5);
  EXPECT_TRUE(std::isfinite(report.violations[0].value));
}

}  // namespace
}  // namespace flexura
