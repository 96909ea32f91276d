#include "flexura/safety/worst.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(Worst, IsFoundInANeedleThatNoGridWouldHit) {
  for_random_cases(100, [](TestRandom& random) {
    const double at = random.uniform(0, 100);
    const double height = random.uniform(1, 5);
    constexpr double width = 1e-4;
    const auto needle = with_rate(
        [=](double t) { return 1 + height * std::max(0.0, 1 - std::abs(t - at) / width); },
        [=](double a, double b) { return a <= at + width && b >= at - width ? height / width : 0; });
    const WorstValue worst = worst_in(needle, {0, 100}, {.tolerance = 1e-3});
    EXPECT_NEAR(worst.value, 1 + height, 1e-3);
    EXPECT_NEAR(worst.time, at, width);
    EXPECT_EQ(worst.uncertainty, 0);
  });
}

TEST(Worst, IsExactAtAnEnd) {
  const auto rising = with_rate([](double t) { return 3 * t; }, [](double, double) { return 3.0; });
  const WorstValue worst = worst_in(rising, {1, 2}, {.part = 1e-9});
  EXPECT_EQ(worst.value, 6);
  EXPECT_EQ(worst.time, 2);
}

TEST(Worst, SaysWhatItCouldNotLookInto) {
  std::size_t asked = 0;
  const WatchedQuantity vague{[](double t) { return std::sin(t); },
                              [&](double, double) {
                                ++asked;
                                return QuantityBounds{-4, 4};
                              }};
  const WorstValue worst = worst_in(vague, {0, 3}, {.tolerance = 1e-3, .most_intervals = 50});
  EXPECT_LE(asked, 51u);
  EXPECT_NEAR(worst.value, 1, 0.1);
  EXPECT_EQ(worst.uncertainty, 4 - worst.value);
}

TEST(Worst, OfNoEndIsSoonFound) {
  const auto pole = with_rate([](double t) { return t < 1 ? 1 / (1 - t) : INFINITY; },
                              [](double, double b) { return b < 1 ? 1 / ((1 - b) * (1 - b)) : INFINITY; });
  EXPECT_EQ(worst_in(pole, {0, 2}, {.part = 1e-5}).value, INFINITY);
}

}  // namespace
}  // namespace flexura
