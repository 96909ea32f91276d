#include "flexura/sim/axis_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/support/motions.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Command {
  double time, target, duration;
  bool is_halt;
};

// An axis with limits of any size, and commands at any times, often while it still moves.
struct RandomCase {
  AxisConfig axis;
  AxisMotion::Backlash backlash;
  double delay = 0, start = 0;
  std::vector<Command> commands;

  explicit RandomCase(TestRandom& random) {
    axis.limits = {-random.uniform(0, 3), random.uniform(0, 3)};
    axis.max_rate = random.integer(0, 5) == 0 ? infinity : std::pow(10.0, random.uniform(-1, 1));
    axis.max_acceleration = random.integer(0, 3) == 0 ? infinity : std::pow(10.0, random.uniform(-1, 2));
    axis.resolution = random.integer(0, 1) == 0 ? 0 : random.uniform(0.001, 0.2);
    backlash = {-random.uniform(0, 0.05), random.uniform(0, 0.05)};
    delay = random.integer(0, 1) == 0 ? 0 : random.uniform(0, 0.5);
    start = random.uniform(axis.limits[0], axis.limits[1]);
    double time = 0;
    for (int count = random.integer(1, 20); count > 0; --count) {
      time += random.integer(0, 4) == 0 ? 0 : std::pow(10.0, random.uniform(-3, 0.5));
      const double duration = random.integer(0, 1) == 0 ? 0 : random.uniform(0, 2);
      commands.push_back({time, random.uniform(-4, 4), duration, random.integer(0, 9) == 0});
    }
  }

  [[nodiscard]] AxisMotion motion(double horizon = forever) const {
    return {axis, backlash, start, delay, horizon};
  }
  [[nodiscard]] AxisMotion commanded() const {
    AxisMotion result = motion();
    for (const Command& command : commands) give(command, result);
    return result;
  }
  static void give(const Command& command, AxisMotion& motion) {
    if (command.is_halt) {
      motion.halt(command.time);
    } else {
      motion.command(command.time, command.target, command.duration);
    }
  }
  [[nodiscard]] double end() const { return commands.back().time + delay + 3; }
};

TEST(AxisMotion, ObeysItsLimitsRateAndAcceleration) {
  for_random_cases(150, [](TestRandom& random) {
    const RandomCase one(random);
    const AxisMotion motion = one.commanded();
    constexpr double step = 1e-3;
    for (double t = 0; t < one.end(); t += step) {
      const double before = motion.motor(t - step), now = motion.motor(t), after = motion.motor(t + step);
      EXPECT_GE(now, one.axis.limits[0] - 1e-12);
      EXPECT_LE(now, one.axis.limits[1] + 1e-12);
      EXPECT_LE(std::abs(now - before), one.axis.max_rate * step * (1 + 1e-9) + 1e-12);
      EXPECT_LE(std::abs(after - 2 * now + before),
                one.axis.max_acceleration * step * step * (1 + 1e-9) + 1e-12);
      EXPECT_LE(std::abs(motion.rate(t)), one.axis.max_rate * (1 + 1e-12));
      if (testing::Test::HasFailure()) FAIL() << t;
    }
  });
}

TEST(AxisMotion, ArrivesAtThePositionNearestToItsTarget) {
  for_random_cases(150, [](TestRandom& random) {
    RandomCase one(random);
    one.commands.back().is_halt = false;
    const AxisMotion motion = one.commanded();
    const double late = one.end() + 1e6;
    EXPECT_EQ(motion.motor(late), commandable(one.axis, one.commands.back().target));
    EXPECT_EQ(motion.rate(late), 0);
    EXPECT_FALSE(motion.is_moving(late));
  });
}

TEST(AxisMotion, IsTheSameToTheBitHoweverOftenItIsAsked) {
  for_random_cases(100, [](TestRandom& random) {
    const RandomCase one(random);
    AxisMotion asked = one.motion(), unasked = one.motion();
    double time = 0;
    for (const Command& command : one.commands) {
      for (; time < command.time; time += random.uniform(0, 0.3)) (void)asked.position(time);
      RandomCase::give(command, asked);
      RandomCase::give(command, unasked);
    }
    for (double t = 0; t < one.end(); t += 0.0107) {
      EXPECT_EQ(asked.motor(t), unasked.motor(t));
      EXPECT_EQ(asked.position(t), unasked.position(t));
    }
  });
}

TEST(AxisMotion, DoesNotKnowACommandBeforeItsDelay) {
  for_random_cases(100, [](TestRandom& random) {
    const RandomCase one(random);
    AxisMotion motion = one.motion();
    for (const Command& command : one.commands) {
      const AxisMotion before = motion;
      RandomCase::give(command, motion);
      for (double t = command.time - 0.2; t < command.time + one.delay; t += 0.01)
        EXPECT_EQ(motion.position(t), before.position(t));
    }
  });
}

// The play operator, followed in small steps.
TEST(AxisMotion, CarriesThroughItsPlay) {
  for_random_cases(60, [](TestRandom& random) {
    RandomCase one(random);
    one.axis.max_rate = std::min(one.axis.max_rate, 10.0);
    const AxisMotion motion = one.commanded();
    double carried = one.start;
    constexpr double step = 2e-4;
    // A step may miss where the motor turned by so much.
    const double missed = std::min(one.axis.max_acceleration * step * step, one.axis.max_rate * step) + 1e-12;
    for (double t = 0; t < one.end(); t += step) {
      const double motor = motion.motor(t);
      carried = std::clamp(carried, motor + one.backlash.low, motor + one.backlash.high);
      ASSERT_NEAR(motion.position(t), carried, missed) << t;
    }
  });
}

TEST(AxisMotion, TakesNoLongerThanItMust) {
  const AxisConfig axis{.limits = {-10, 10}, .max_rate = 2, .max_acceleration = 4};
  AxisMotion motion(axis, {}, 0, 0.1, forever);
  motion.command(1, 5);  // half a second to 2/s, over 0.5; cruise over 4; the same down
  EXPECT_EQ(motion.motor(1.1), 0);
  EXPECT_NEAR(motion.motor(1.6), 0.5, 1e-14);
  EXPECT_NEAR(motion.rate(2), 2, 1e-14);
  EXPECT_TRUE(motion.is_moving(4.09));
  EXPECT_FALSE(motion.is_moving(4.11));
  EXPECT_EQ(motion.motor(4.11), 5);
  // Turned back at full rate: it brakes over 0.5, and returns.
  AxisMotion turned(axis, {}, 0, 0, forever);
  turned.command(0, 9);
  turned.command(1, 0);
  EXPECT_NEAR(turned.motor(1.5), 2, 1e-14);
  EXPECT_NEAR(turned.rate(1.5), 0, 1e-14);
  EXPECT_NEAR(turned.motor(3), 0, 1e-14);
  EXPECT_FALSE(turned.is_moving(3.0001));
}

TEST(AxisMotion, TakesTheTimeItIsGivenOrTheShortest) {
  int timed = 0, braked = 0;
  for_random_cases(200, [&](TestRandom& random) {
    RandomCase one(random);
    one.commands.back().is_halt = false;
    one.commands.back().duration = 0;
    const double start = one.commands.back().time + one.delay;
    const AxisMotion fast = one.commanded();
    one.commands.back().duration = random.uniform(0, 3);
    const AxisMotion slow = one.commanded();
    const double target = commandable(one.axis, one.commands.back().target);
    // It may be there, or come to rest there by itself on its way to the same place.
    const double rate = fast.rate(start);
    const double stop = fast.motor(start) + rate * std::abs(rate) / (2 * one.axis.max_acceleration);
    if (std::abs(stop - target) < 1e-9) return;
    // When it comes to rest, by bisection.
    const auto end = [&](const AxisMotion& motion) {
      double low = start, high = start + 1e4;
      while (high - low > 1e-9) (motion.is_moving(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
      return low - start;
    };
    ++timed;
    EXPECT_NEAR(end(slow), std::max(end(fast), one.commands.back().duration), 1e-6);
    // Without a jump: what is left before the end is what the brake takes.
    if (!std::isfinite(one.axis.max_acceleration)) return;
    ++braked;
    const double before = start + end(slow) - 1e-6;
    EXPECT_NEAR(slow.motor(before), target, 1e-6 * one.axis.max_acceleration * 1e-5 + 1e-9);
  });
  EXPECT_GT(timed, 120 / one_case_of);
  EXPECT_GT(braked, 40 / one_case_of);
}

TEST(AxisMotion, WithoutLimitsIsThereAtOnce) {
  AxisMotion motion({.limits = {-10, 10}}, {-0.1, 0.1}, 0, 0, forever);
  motion.command(1, 3);
  EXPECT_EQ(motion.motor(0.999), 0);
  EXPECT_EQ(motion.motor(1), 3);
  EXPECT_EQ(motion.position(1), 2.9);
  motion.command(2, 2.95);
  EXPECT_EQ(motion.position(2), 2.9);
}

TEST(AxisMotion, HaltsAtItsFullAcceleration) {
  AxisMotion motion({.limits = {-10, 10}, .max_rate = 2, .max_acceleration = 4, .resolution = 1}, {}, 0, 0,
                    forever);
  motion.command(0, 9);
  motion.halt(2);
  EXPECT_NEAR(motion.rate(2.25), 1, 1e-14);
  EXPECT_NEAR(motion.motor(3), 4, 1e-14);  // 3.5 at 2 s, and 0.5 of braking
  EXPECT_FALSE(motion.is_moving(2.5001));
}

TEST(AxisMotion, ForgetsWhatIsBeyondItsHorizonAndNothingElse) {
  for_random_cases(100, [](TestRandom& random) {
    const RandomCase one(random);
    AxisMotion remembers = one.motion(), forgets = one.motion(0.4);
    for (const Command& command : one.commands) {
      RandomCase::give(command, remembers);
      RandomCase::give(command, forgets);
      for (double t = command.time - 0.39; t < command.time + 1; t += 0.0313)
        EXPECT_EQ(forgets.position(t), remembers.position(t));
    }
  });
}

TEST(AxisMotion, RefusesWhatIsNoCommand) {
  AxisMotion motion({.limits = {-1, 1}}, {}, 0, 0, forever);
  EXPECT_THROW(motion.command(0, std::nan("")), std::invalid_argument);
  EXPECT_THROW(motion.command(infinity, 0), std::invalid_argument);
  motion.command(5, 1);
  EXPECT_THROW(motion.command(4, 0), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
