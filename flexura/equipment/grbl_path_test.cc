#include "flexura/equipment/grbl_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "flexura/equipment/grbl_motion.h"

namespace flexura {
namespace {

using Steps = std::vector<std::int64_t>;

constexpr double tolerance = 2;  // Steps.

GrblPath path_at_zero() {
  return GrblPath({.per_mm = {100, 100}, .rates = {50, 50}, .accelerations = {1e4, 1e4}});
}

// There and back over the same line, at 10 mm/s: 1000 steps take 1 s.
TEST(GrblPath, KnowsTheWayBackFromTheWayThere) {
  GrblPath path = path_at_zero();
  path.add({800, 600}, 600, 0);
  path.add({0, 0}, 600, 0);
  EXPECT_TRUE(path.can_be_at(Steps{400, 300}, tolerance, 0.5));
  path.report(Steps{400, 300}, 0.5, 0.5);
  EXPECT_TRUE(path.can_be_at(Steps{760, 570}, tolerance, 0.95));
  path.report(Steps{760, 570}, 0.95, 0.95);
  // 50 steps to the turn and 100 back.
  EXPECT_TRUE(path.can_be_at(Steps{720, 540}, tolerance, 1.1));
  EXPECT_FALSE(path.can_be_at(Steps{720, 540}, tolerance, 1.0)) << "too early";
  EXPECT_FALSE(path.can_be_at(Steps{720, 560}, tolerance, 1.1)) << "beside the line";
  path.report(Steps{720, 540}, 1.1, 1.1);
  EXPECT_FALSE(path.can_be_at(Steps{760, 570}, tolerance, 1.2)) << "behind";
  EXPECT_TRUE(path.can_be_at(Steps{400, 300}, tolerance, 1.5));
  EXPECT_NEAR(path.lag(1.1), 0.9, 0.02);
}

// A report of the turn itself, before the controller goes back.
TEST(GrblPath, KnowsTheWayBackAfterAReportOfTheTurn) {
  GrblPath path = path_at_zero();
  path.add({800, 600}, 600, 0);
  path.add({0, 0}, 600, 0);
  path.report(Steps{800, 600}, 1, 1);
  EXPECT_TRUE(path.can_be_at(Steps{640, 480}, tolerance, 1.2));
  path.report(Steps{640, 480}, 1.2, 1.2);
  EXPECT_NEAR(path.lag(1.2), 0.8, 0.02);
}

// A servo close to its target sends short motions that often go back over the ones before. Whenever a
// controller reports its position, and wherever it brakes, this must be a place that the path allows.
TEST(GrblPath, AllowsAllPlacesOfASimulatedController) {
  constexpr std::size_t axes = 3;
  constexpr double per_mm = 100;
  constexpr unsigned runs = 200, commands = 100;
  const GrblLimits limits{.rates = {50, 50, 50}, .accelerations = {500, 500, 500}};
  std::size_t reports = 0;
  for (unsigned seed = 0; seed < runs; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
    };
    GrblMotion motion(axes, 15);
    GrblPath path({std::vector<double>(axes, per_mm), limits.rates, limits.accelerations});
    double now = 0;
    const auto pass = [&](double duration) {
      for (const double end = now + duration; now < end; now += GrblMotion::tick) motion.step();
    };
    const auto place = [&] {
      Steps steps;
      for (const double mm : motion.position()) steps.push_back(std::llround(mm * per_mm));
      return steps;
    };
    const double reach = std::pow(10, uniform(0.3, 2.7));  // Steps.
    for (unsigned i = 0; i < commands; ++i) {
      Steps target = path.end();
      for (std::int64_t& one : target) one += std::llround(uniform(-reach, reach));
      const double duration = uniform(0.02, 0.2);
      const double feed = path.feed_to(target, duration, 0.1, now);
      if (!motion.is_full() && target != path.end()) {
        std::vector<double> mm;
        for (const std::int64_t one : target) mm.push_back(static_cast<double>(one) / per_mm);
        path.add(target, feed, now);
        motion.add(mm, feed / 60, limits);
      }
      pass(uniform(0, 0.2));
      if (random() % 2 == 0) continue;
      ++reports;
      ASSERT_TRUE(path.can_be_at(place(), tolerance, now)) << "seed " << seed << ", command " << i;
      if (random() % 8 == 0) {
        motion.brake();
        while (!motion.is_resting()) pass(0.01);
        ASSERT_TRUE(path.can_be_at(place(), tolerance, now)) << "braked; seed " << seed << ", command " << i;
        path.stop(place(), now);
        motion.reset();
      } else if (motion.is_idle()) {
        path.rest(place(), now);
      } else {
        path.report(place(), now, now);
      }
    }
  }
  std::printf("%zu reports, seeds 0 to %u\n", reports, runs - 1);
}

// Motions of a step or two for ten minutes: each report fits all of them.
TEST(GrblPath, RemembersNoMoreThanAControllersQueue) {
  GrblPath path = path_at_zero();
  std::mt19937 random(1);
  double now = 0;
  std::size_t refused = 0;
  for (int i = 0; i < 12000; ++i, now += 0.05) {
    const Steps target{static_cast<std::int64_t>(random() % 3), static_cast<std::int64_t>(random() % 3)};
    if (target != path.end()) path.add(target, path.feed_to(target, 0.05, 0.1, now), now);
    refused += path.can_be_at(target, tolerance, now) ? 0 : 1;
    path.report(target, now, now);
  }
  EXPECT_EQ(refused, 0U);
  EXPECT_LE(path.legs(), 1000U);
  path.rest({1, 1}, now);
  EXPECT_EQ(path.legs(), 0U);
}

}  // namespace
}  // namespace flexura
