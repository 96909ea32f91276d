#include "flexura/view/run_pace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexura {
namespace {

constexpr double tick = 1.0 / 60, step = 0.01;

TEST(RunPace, GoesWithTheClock) {
  for (const double speed : {0.25, 1.0, 4.0}) {
    RunPace pace(speed, step);
    double reached = 0;
    for (int i = 0; i < 120; ++i) reached = pace.next(tick, reached);
    EXPECT_NEAR(reached, speed * 2, 1e-9) << speed;
    EXPECT_FALSE(pace.slowness()) << speed;
  }
}

TEST(RunPace, LetsItGoAsFastAsItCan) {
  RunPace pace(0, step);
  EXPECT_TRUE(std::isinf(pace.next(tick, 0)));
  EXPECT_FALSE(pace.slowness());
  (void)pace.next(tick, 7);
  pace.set_speed(1);
  EXPECT_NEAR(pace.next(tick, 7), 7 + tick, 1e-9) << "it goes on from where it is";
}

TEST(RunPace, MakesUpForNoPause) {
  RunPace pace(1, step);
  EXPECT_LT(pace.next(100, 0), 0.3) << "nobody looked for so long";
}

TEST(RunPace, SaysThatARunDoesNotKeepUp) {
  RunPace pace(1, step);
  double reached = 0;
  for (int i = 0; i < 300; ++i) (void)pace.next(tick, reached += 0.25 * tick);
  ASSERT_TRUE(pace.slowness());
  EXPECT_NEAR(*pace.slowness(), 0.25, 0.01);
  EXPECT_LT(pace.next(tick, reached), reached + 0.11) << "it does not rush afterwards";
}

// A step may last longer than what a person would wait for.
TEST(RunPace, LetsARunTakeItsNextStep) {
  constexpr double long_step = 2;
  RunPace pace(0.25, long_step);
  double reached = 0;
  int ticks = 0;
  while (reached < 3 * long_step && ++ticks < 10000)
    if (pace.next(tick, reached) >= reached + long_step) reached += long_step;
  EXPECT_EQ(reached, 3 * long_step);
}

}  // namespace
}  // namespace flexura
