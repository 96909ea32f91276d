#include "flexura/kinematics/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/arms.h"
#include "tests/support/motions.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

std::vector<Profile> random_profiles(TestRandom& random) {
  return {Profile::linear(random.uniform(0.1, 10)), Profile::minimum_jerk(random.uniform(0.1, 10)),
          Profile::trapezoid(random.uniform(0.01, 3), random.uniform(0.1, 2), random.uniform(0.1, 5))};
}

TEST(Profile, GoesFromZeroToOneWithoutTurningBack) {
  for_random_cases(100, [](TestRandom& random) {
    for (const Profile& profile : random_profiles(random)) {
      EXPECT_EQ(profile.fraction(0), 0);
      EXPECT_EQ(profile.fraction(profile.duration()), 1);
      EXPECT_NEAR(profile.fraction(profile.duration() / 2), 0.5, 1e-15);
      double last = 0;
      for (int k = 1; k <= 1000; ++k) {
        const double now = profile.fraction(profile.duration() * k / 1000);
        EXPECT_GE(now, last - 1e-15);
        last = now;
      }
    }
  });
}

TEST(Profile, RateIsTheDerivativeOfTheFraction) {
  for_random_cases(200, [](TestRandom& random) {
    for (const Profile& profile : random_profiles(random)) {
      const double h = 1e-5 * profile.duration();
      const double t = random.uniform(2 * h, profile.duration() - 2 * h);
      const double difference = (profile.fraction(t + h) - profile.fraction(t - h)) / (2 * h);
      EXPECT_NEAR(profile.rate(t), difference, 2e-4 / profile.duration());
    }
  });
}

TEST(Profile, BoundsItsRateExactly) {
  for_random_cases(200, [](TestRandom& random) {
    for (const Profile& profile : random_profiles(random)) {
      const double start = random.uniform(0, profile.duration());
      const double end = random.uniform(start, profile.duration());
      double most = 0;
      double least = std::min(profile.rate(start), profile.rate(end));
      for (int k = 0; k <= 2000; ++k) {
        const double rate = profile.rate(std::min(end, start + (end - start) * k / 2000));
        most = std::max(most, rate);
        least = std::min(least, rate);
      }
      EXPECT_LE(most, profile.max_rate(start, end) * (1 + 1e-14));
      EXPECT_GE(most, profile.max_rate(start, end) * (1 - 1e-2));
      EXPECT_DOUBLE_EQ(least, profile.min_rate(start, end));  // Taken at one of the ends.
    }
  });
}

TEST(Profile, MinimumJerkHasItsKnownPeakAndRestsAtItsEnds) {
  const Profile profile = Profile::minimum_jerk(2);
  EXPECT_DOUBLE_EQ(profile.max_rate(0, 2), 1.875 / 2);
  EXPECT_EQ(profile.rate(0), 0);
  EXPECT_NEAR(profile.fraction(1e-4), 10 * std::pow(0.5e-4, 3), 1e-15);  // No velocity, no acceleration.
}

TEST(Profile, TrapezoidUsesItsLimitsAndNoMore) {
  const Profile reaches = Profile::trapezoid(1.0, 0.5, 1.0);  // 0.5 s up, 1.5 s constant, 0.5 s down.
  EXPECT_DOUBLE_EQ(reaches.duration(), 2.5);
  EXPECT_DOUBLE_EQ(reaches.max_rate(0, 2.5), 0.5);
  EXPECT_DOUBLE_EQ(reaches.fraction(0.5), 0.125);
  const Profile falls_short = Profile::trapezoid(1.0, 10.0, 1.0);  // 1 s up, 1 s down.
  EXPECT_DOUBLE_EQ(falls_short.duration(), 2.0);
  EXPECT_DOUBLE_EQ(falls_short.max_rate(0, 2), 1.0);
}

TEST(Profile, RefusesWhatIsNoMotion) {
  EXPECT_THROW((void)Profile::linear(0), std::invalid_argument);
  EXPECT_THROW((void)Profile::linear(std::nan("")), std::invalid_argument);
  EXPECT_THROW((void)Profile::trapezoid(0, 1, 1), std::invalid_argument);
  EXPECT_THROW((void)Profile::trapezoid(1, -1, 1), std::invalid_argument);
}

TEST(Motion, NeverGoesFasterThanItsRatesSay) {
  for_random_cases(60, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    for (const MotionPtr& motion : random_motions(random, arm)) {
      const double start = random.uniform(0, motion->duration());
      const double end = random.uniform(start, motion->duration());
      constexpr int steps = 500;
      const double h = (end - start) / steps;
      for (int k = 0; k < steps; ++k) {
        const ArmState a = motion->at(start + k * h);
        const ArmState b = motion->at(start + (k + 1) * h);
        for (std::size_t i = 0; i < arm.sections.size(); ++i) {
          const auto bound = motion->rates(i, start, end);
          ASSERT_TRUE(bound.has_value());
          EXPECT_LE((b.bends[i] - a.bends[i]).norm(), bound->bend * h + 1e-12);
          EXPECT_LE(std::abs(b.stretches[i] - a.stretches[i]), bound->stretch * h + 1e-12);
        }
      }
    }
  });
}

TEST(Motion, KeyframesArePassedExactly) {
  for_random_cases(50, [](TestRandom& random) {
    std::vector<ArmState> states;
    std::vector<double> times;
    for (int k = 0; k < 5; ++k) {
      times.push_back(k * 0.7);
      states.push_back({{random.vector<2>(-3, 3)}, {random.uniform(0.5, 2)}});
    }
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::smooth}) {
      const MotionPtr motion = keyframe_motion(times, states, interpolation);
      for (std::size_t k = 0; k < 5; ++k) {
        EXPECT_LT((motion->at(times[k]).bends[0] - states[k].bends[0]).norm(), 1e-14);
        EXPECT_NEAR(motion->at(times[k]).stretches[0], states[k].stretches[0], 1e-14);
      }
    }
  });
}

TEST(Motion, SmoothKeyframesHaveNoCornersAndRestAtTheEnds) {
  const std::vector<ArmState> states{{{{0, 0}}, {1}}, {{{1, 0}}, {1}}, {{{-1, 0.5}}, {1}}, {{{0, 0}}, {1}}};
  const MotionPtr motion = keyframe_motion({0, 1, 1.5, 3}, states, Interpolation::smooth);
  constexpr double h = 1e-6;
  const auto rate = [&](double a, double b) -> Eigen::Vector2d {
    return (motion->at(b).bends[0] - motion->at(a).bends[0]) / (b - a);
  };
  for (const double t : {1.0, 1.5}) EXPECT_LT((rate(t, t + h) - rate(t - h, t)).norm(), 1e-4);
  EXPECT_LT(rate(0, h).norm(), 1e-4);
  EXPECT_LT(rate(3 - h, 3).norm(), 1e-4);
}

TEST(Motion, ASineStartsWhereTheArmIs) {
  const MotionPtr motion = sine_motion({{{0.3, 0.1}}, {1}}, {{0.5, 0}}, {1.2}, 2.0, 8.0);
  EXPECT_EQ(motion->at(0).bends[0], Eigen::Vector2d(0.3, 0.1));
  EXPECT_NEAR(motion->at(0.7).bends[0].x(), motion->at(4.7).bends[0].x(), 1e-14);
}

TEST(Motion, RefusesKeyframesOutOfOrder) {
  const ArmState state = ArmState::straight(1);
  EXPECT_THROW((void)keyframe_motion({0, 1, 1}, {state, state, state}, Interpolation::linear),
               std::invalid_argument);
  EXPECT_THROW((void)keyframe_motion({1, 2}, {state, state}, Interpolation::linear), std::invalid_argument);
  EXPECT_THROW((void)keyframe_motion({0}, {state}, Interpolation::linear), std::invalid_argument);
  EXPECT_THROW((void)keyframe_motion({0, 1}, {state, ArmState::straight(2)}, Interpolation::linear),
               std::invalid_argument);
}

}  // namespace
}  // namespace flexura
