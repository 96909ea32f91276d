#include "flexura/safety/spans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(Spans, FindWhatRisesAboveALimitFromStartToEnd) {
  const auto sine = with_rate([](double t) { return std::sin(t); }, [](double, double) { return 1.0; });
  const std::vector<Span> spans = spans_above(0.5, sine, {0, 10}, 1e-7);
  ASSERT_EQ(spans.size(), 2u);
  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(spans[0].start, pi / 6, 1e-7);
  EXPECT_NEAR(spans[0].end, 5 * pi / 6, 1e-7);
  EXPECT_NEAR(spans[1].start, 2 * pi + pi / 6, 1e-7);
  EXPECT_NEAR(spans[1].end, 2 * pi + 5 * pi / 6, 1e-7);
}

TEST(Spans, FindANeedleThatNoGridWouldHit) {
  for_random_cases(100, [](TestRandom& random) {
    const double at = random.uniform(0, 10);
    constexpr double width = 1e-5;
    const auto needle = with_rate([at](double t) { return 1 - std::abs(t - at) / width; },
                                  [](double, double) { return 1 / width; });
    const std::vector<Span> spans = spans_above(0, needle, {0, 10}, 1e-7);
    ASSERT_EQ(spans.size(), 1u);
    EXPECT_NEAR(spans[0].start, std::max(0.0, at - width), 1e-7);
    EXPECT_NEAR(spans[0].end, std::min(10.0, at + width), 1e-7);
  });
}

TEST(Spans, WhatTouchesTheLimitIsNotAboveIt) {
  const auto sine = with_rate([](double t) { return std::sin(t); }, [](double, double) { return 1.0; });
  EXPECT_TRUE(spans_above(1.0, sine, {0, 10}, 1e-3).empty());
  const auto even = with_rate([](double) { return 2.0; }, [](double, double) { return 0.0; });
  EXPECT_TRUE(spans_above(2.0, even, {0, 10}, 1e-7).empty());
}

TEST(Spans, AnInstantIsJudgedByItsValue) {
  const auto even = with_rate([](double) { return 2.0; }, [](double, double) { return 1e9; });
  EXPECT_TRUE(spans_above(2.0, even, {3, 3}, 1e-7).empty());
  EXPECT_EQ(spans_above(1.9, even, {3, 3}, 1e-7).size(), 1u);
}

}  // namespace
}  // namespace flexura
