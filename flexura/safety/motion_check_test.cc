#include "flexura/safety/motion_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/safety/jumps.h"
#include "tests/support/arms.h"
#include "tests/support/sampled_check.h"

namespace flexura {
namespace {

using testing::HasSubstr;

Arm short_section() {
  Arm arm;
  arm.sections.resize(1);
  return arm;
}

Arm elastic_section() {
  Arm arm = short_section();
  arm.sections[0].stretch_limits = {0.5, 2};
  return arm;
}

ArmState bent(double bend) { return {{{bend, 0}}, {1}}; }

SafetyReport check(const Arm& arm, MotionPtr motion, double step = 0.02) {
  const ArmState initial = motion->at(0);
  return check_motions(arm, {}, initial, {{std::move(motion), 0}}, step);
}

TEST(MotionCheck, MissesNothingThatDenseSamplingFinds) {
  SampledComparison result;
  for_random_cases(1, [&](TestRandom& random) {
    compare_with_samples(random, 1000, result);
    EXPECT_EQ(result.missed, 0U);
    EXPECT_EQ(result.contacts_missed, 0U);
    EXPECT_EQ(result.refuted, 0U);
    EXPECT_EQ(result.understated, 0U);
    EXPECT_EQ(result.overstated, 0U);
  });
  EXPECT_GE(result.motions, 6U);
  EXPECT_GT(result.above, 100U);
  EXPECT_GT(result.contacts, 0U);
}

TEST(MotionCheck, FindsTheWorstValueOfALongSpan) {
  Arm arm = short_section();
  arm.sections[0].max_bend = 10 * degree;
  const ArmState slight = bent(12 * degree);
  const auto law = keyframe_motion(
      {0, 1, 1.05, 1.1, 20}, {slight, slight, bent(100 * degree), slight, slight}, Interpolation::linear);
  const SafetyReport report = check(arm, law);
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_EQ(report.violations[0].start, 0);
  EXPECT_EQ(report.violations[0].end, 20);
  EXPECT_NEAR(report.violations[0].value, 100 * degree, 1e-3 * degree);
  EXPECT_NEAR(report.violations[0].worst_time, 1.05, 1e-5);
}

TEST(MotionCheck, AMeanRateIsThatOfTheWholeStep) {
  Arm arm = short_section();
  arm.sections[0].max_bend_rate = 1;
  const auto formula = function_motion(3, [](double t) { return bent(t > 1 && t < 1.2 ? 2 * (t - 1) : 0); });
  const SafetyReport report = check(arm, formula, 0.1);
  const auto rate = std::ranges::find(report.violations, Hazard::bend_rate, &Violation::hazard);
  ASSERT_NE(rate, report.violations.end());
  EXPECT_NEAR(rate->start, 1, 1e-9);
  EXPECT_NEAR(rate->end, 1.2, 1e-9);
}

// Counts its calls and ends the check after this number.
class Impatient : public Progress {
 public:
  explicit Impatient(int patience) : patience_(patience) {}
  void update(double fraction, std::string_view what) override {
    EXPECT_GE(fraction, last_);
    EXPECT_LE(fraction, 1);
    EXPECT_EQ(what, "check: curl");
    last_ = fraction;
    ++reported_;
  }
  [[nodiscard]] bool is_cancelled() const override { return reported_ >= patience_; }
  [[nodiscard]] int reported() const { return reported_; }

 private:
  int patience_;
  int reported_ = 0;
  double last_ = 0;
};

TEST(MotionCheck, TellsHowFarItIsAndEndsWhenAsked) {
  Arm arm;
  arm.sections.resize(5);
  ArmState curled = ArmState::straight(5);
  for (auto& bend : curled.bends) bend.x() = 1.5;
  const auto law = point_to_point_motion(ArmState::straight(5), curled, std::vector(5, Profile::linear(2)));
  const auto formula = function_motion(2, [law](double t) { return law->at(t); });
  for (const MotionPtr& motion : {law, formula}) {
    const auto watched = [&](Progress& progress) {
      return check_motions(arm, {}, motion->at(0), {{motion, 0, "curl"}}, 0.02, &progress);
    };
    Impatient patient(1'000'000);
    const SafetyReport whole = watched(patient);
    EXPECT_TRUE(whole.is_complete);
    EXPECT_GT(patient.reported(), 10);
    Impatient impatient(3);
    const SafetyReport part = watched(impatient);
    EXPECT_EQ(impatient.reported(), 3);
    EXPECT_FALSE(part.is_safe());
    EXPECT_THAT(part.caveats, testing::Contains(HasSubstr("cancelled")));
  }
}

TEST(MotionCheck, TellsWhenWhereAndHowMuch) {
  Arm arm = short_section();
  arm.sections[0].max_bend = 1;
  const SafetyReport report = check(arm, point_to_point_motion(bent(0), bent(2), {Profile::linear(4)}));
  ASSERT_EQ(report.violations.size(), 1u);
  const Violation& violation = report.violations[0];
  EXPECT_EQ(violation.hazard, Hazard::bend);
  EXPECT_NEAR(violation.start, 2, 1e-6);
  EXPECT_EQ(violation.end, 4);
  EXPECT_EQ(violation.worst_time, 4);
  EXPECT_EQ(violation.section, 0u);
  EXPECT_EQ(violation.value, 2);
  EXPECT_EQ(violation.limit, 1);
  EXPECT_THAT(violation.text(), HasSubstr("s to 4 s: section 1: bend 114.592 deg, limit 57.2958 deg"));
}

TEST(MotionCheck, LimitsThatAreJustTouchedAreKept) {
  Arm arm = short_section();
  arm.sections[0].max_bend = 2;
  arm.sections[0].stretch_limits = {0.5, 1};
  arm.sections[0].max_bend_rate = 1.875;
  EXPECT_TRUE(check(arm, point_to_point_motion(bent(1), bent(2), {Profile::minimum_jerk(1)})).is_safe());
  arm.sections[0].max_bend_rate = 2 * std::numbers::pi;
  EXPECT_TRUE(check(arm, sine_motion(bent(1), {{1, 0}}, {0}, 1, 3)).is_safe());
  arm.sections[0].max_bend_rate = 1.5;  // Largest rate of a cubic from rest to rest.
  EXPECT_TRUE(check(arm, keyframe_motion({0, 1}, {bent(0), bent(1)}, Interpolation::smooth)).is_safe());
}

TEST(MotionCheck, ATubeFoldsWhereItReachesItsLimit) {
  Arm arm = short_section();
  arm.sections[0].radius = {0.2, 0.5};
  const SafetyReport report = check(arm, hold_motion(bent(2), 1));
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].hazard, Hazard::folding);
}

TEST(MotionCheck, FindsJumpsBetweenTasks) {
  const SafetyReport report = check_motions(
      short_section(), {}, bent(0), {{hold_motion(bent(0), 1), 0}, {hold_motion(bent(0.1), 1), 1}}, 0.02);
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].hazard, Hazard::jump);
  EXPECT_EQ(report.violations[0].start, 1);
  EXPECT_DOUBLE_EQ(report.violations[0].value, 0.1);
  EXPECT_EQ(report.violations[0].text(), "at 1 s: section 1: jump 5.72958 deg");
  const SafetyReport stretched =
      check_motions(elastic_section(), {}, bent(0),
                    {{hold_motion(bent(0), 1), 0}, {hold_motion({{{0, 0}}, {1.25}}, 1), 1}}, 0.02);
  ASSERT_EQ(stretched.violations.size(), 1u);
  EXPECT_EQ(stretched.violations[0].text(), "at 1 s: section 1: jump of 0.25 in stretch");
}

TEST(MotionCheck, KeepsJumpsOfBendsAndStretchesApart) {
  const auto at_once =
      keyframe_motion({0, 1, 1 + 1e-6, 2}, {bent(0), bent(0), {{{0.1, 0}}, {1.3}}, {{{0.1, 0}}, {1.3}}},
                      Interpolation::linear);
  const SafetyReport report = check_motions(elastic_section(), {}, bent(0), {{at_once, 0}}, 0.02);
  ASSERT_EQ(report.violations.size(), 2u);
  for (const Violation& violation : report.violations) {
    EXPECT_EQ(violation.hazard, Hazard::jump);
    EXPECT_NEAR(violation.value, violation.is_of_stretch ? 0.3 : 0.1, 1e-6);
  }
  EXPECT_NE(report.violations[0].is_of_stretch, report.violations[1].is_of_stretch);
}

TEST(MotionCheck, FindsJumpsInFormulasAndNoneWhereTheyAreOnlyFast) {
  for_random_cases(200, [](TestRandom& random) {
    const double at = random.uniform(0.5, 1.5);
    const double size = random.uniform(1e-3, 1);
    const double slope = random.uniform(0, 1e-2);
    const auto step = function_motion(2, [=](double t) { return bent(slope * t + (t > at ? size : 0)); });
    const std::vector<Jump> jumps = find_jumps(*step, 0.02);
    ASSERT_EQ(jumps.size(), 1u);
    EXPECT_NEAR(jumps[0].time, at, 1e-9);
    EXPECT_NEAR(jumps[0].size, size, 1e-9);
    const double steepness = random.uniform(1, 1e6);
    const auto fast = function_motion(2, [=](double t) { return bent(std::tanh(steepness * (t - at))); });
    EXPECT_TRUE(find_jumps(*fast, 0.02).empty()) << steepness;
  });
}

TEST(MotionCheck, TheSearchForJumpsCanBeEnded) {
  int asked = 0;
  const auto motion = function_motion(2, [&](double) { return ++asked, bent(0); });
  std::vector<double> shares;
  (void)find_jumps(*motion, 0.01, 2, [&](double done) { return shares.push_back(done), shares.size() < 5; });
  EXPECT_EQ(shares, (std::vector<double>{0.005, 0.01, 0.015, 0.02, 0.025}));
  EXPECT_LE(asked, 6);
}

TEST(MotionCheck, SaysWhatItOnlySampled) {
  const auto formula = function_motion(3, [](double t) { return bent(0.1 * t); });
  const SafetyReport report = check(short_section(), formula, 0.05);
  EXPECT_TRUE(report.is_safe());
  EXPECT_THAT(
      report.caveats,
      testing::ElementsAre("0 s to 3 s: sampled every 0.05 s: no bound on the rates of the motion is known"));
  EXPECT_THAT(
      check(short_section(), formula, 1000).caveats,
      testing::ElementsAre(
          "0 s to 3 s: sampled only at its start and its end: no bound on the rates of the motion is known"));
  EXPECT_TRUE(check(short_section(), hold_motion(bent(0), 1)).caveats.empty());
}

TEST(MotionCheck, SamplesAFormulaWhenTheClockWillHoweverItsTaskBegins) {
  Arm arm = short_section();
  arm.sections[0].max_bend = 0.5;
  // Narrower than a clock step, at about 0.7 s.
  const auto peak =
      function_motion(0.6, [](double t) { return bent(std::exp(-std::pow((t - 0.15) / 0.015, 2))); });
  const ArmState start = bent(0);
  const SafetyReport found =
      check_motions(arm, {}, start, {{hold_motion(start, 0.55), 0}, {peak, 0.55}}, 0.1);
  ASSERT_FALSE(found.is_safe());
  EXPECT_EQ(found.violations.front().hazard, Hazard::bend);
  EXPECT_NEAR(found.violations.front().worst_time, 0.7, 1e-12);
  EXPECT_NEAR(found.violations.front().value, 1, 1e-12);
  // No clock step is at the peak.
  EXPECT_TRUE(check_motions(arm, {}, start, {{hold_motion(start, 0.5), 0}, {peak, 0.5}}, 0.1).is_safe());
}

TEST(MotionCheck, FindsFormulasThatLeaveNoLength) {
  const auto no_length = function_motion(2, [](double t) -> ArmState { return {{{0, 0}}, {1 - t}}; });
  const SafetyReport shrunk = check(short_section(), no_length, 0.1);
  ASSERT_FALSE(shrunk.is_safe());
  EXPECT_EQ(shrunk.violations.back().hazard, Hazard::not_finite);
  EXPECT_NEAR(shrunk.violations.back().start, 1, 1e-9);
}

TEST(MotionCheck, RefusesThousandsOfTurns) {
  const SafetyReport report =
      check(short_section(), point_to_point_motion(bent(0), bent(5000), {Profile::linear(1)}), 0.1);
  ASSERT_FALSE(report.is_safe());
  EXPECT_EQ(report.violations[0].hazard, Hazard::not_finite);
}

TEST(MotionCheck, ChecksAFormulaUpToWhereItHasNoValueAndNamesTaskAndSection) {
  Arm arm;
  arm.sections.resize(2);
  arm.sections[0].max_bend = 0.5;
  const auto law = function_motion(2, [](double t) -> ArmState {
    return {{{t, 0}, {t < 0.4 ? std::sqrt(1 - t) : std::sqrt(1 - t) + 0.1, 0}}, {1, 1}};
  });
  const SafetyReport report = check_motions(arm, {}, law->at(0), {{law, 3, "reach"}}, 0.1);
  ASSERT_EQ(report.violations.size(), 3u);
  EXPECT_THAT(report.violations[0].text(), testing::StartsWith("at 3.4 s: reach: section 2: jump 5.729"));
  EXPECT_EQ(report.violations[1].hazard, Hazard::bend);
  EXPECT_NEAR(report.violations[1].end, 4, 1e-9);
  EXPECT_EQ(report.violations[2].text(), "at 4.1 s: reach: section 2: no possible value");
}

TEST(MotionCheck, EndsSoonWhereKeyframesLeaveNoLength) {
  // Smooth keyframes overshoot: the stretch falls below 0 for a while.
  const auto state = [](double stretch) -> ArmState { return {{{0.5, 0}}, {stretch}}; };
  const auto law = keyframe_motion(
      {0, 1, 2, 3, 4}, {state(1), state(0.05), state(0.01), state(0.05), state(1)}, Interpolation::smooth);
  ASSERT_LT(law->at(1.5).stretches[0], 0);
  const SafetyReport report = check(short_section(), law);
  ASSERT_FALSE(report.is_safe());
  for (const Violation& violation : report.violations)
    EXPECT_TRUE(violation.hazard == Hazard::stretch || violation.hazard == Hazard::folding)
        << violation.text();
}

TEST(MotionCheck, ASingularPoseIsANoteOnly) {
  const Arm arm = paper_arm();
  const SafetyReport report = check(
      arm, point_to_point_motion(ArmState::straight(8), paper_state(), std::vector(8, Profile::linear(5))));
  EXPECT_TRUE(report.is_safe());
  EXPECT_THAT(report.notes, testing::ElementsAre("0 s: singular: the tip Jacobian has rank 1 of 2"));
}

TEST(MotionCheck, TellsTheTimesOfAShortSpanApart) {
  Arm arm = short_section();
  arm.sections[0].max_bend = 1;
  const SafetyReport report =
      check(arm, point_to_point_motion(bent(0), bent(1 + 1e-8), {Profile::linear(1)}));
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_THAT(report.violations[0].text(),
              testing::MatchesRegex("0\\.999999[0-9]+ s to 1 s: section 1: bend .*"));
}

TEST(MotionCheck, FindsAPeakBetweenTwoSamplesOfTheClock) {
  Arm arm = short_section();
  arm.sections[0].max_bend = 0.999;
  const MotionPtr swing = sine_motion(bent(0), {{1, 0}}, {0}, 4, 2);  // Above the limit for 57 ms.
  const SafetyReport report = check(arm, swing, 0.7);
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_NEAR(report.violations[0].start, std::asin(0.999) * 2 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(report.violations[0].value, 1, 1e-4);
}

TEST(MotionCheck, FindsATooFastPieceOfAMicrosecond) {
  Arm arm = short_section();
  arm.sections[0].max_bend_rate = 1;
  const auto keyframes =
      keyframe_motion({0, 5, 5 + 1e-6, 10}, {bent(0), bent(0), bent(1e-5), bent(0)}, Interpolation::linear);
  const SafetyReport report = check(arm, keyframes);
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].hazard, Hazard::bend_rate);
  EXPECT_NEAR(report.violations[0].start, 5, 1e-6);
  EXPECT_NEAR(report.violations[0].value, 10, 1e-4);
}

}  // namespace
}  // namespace flexura
