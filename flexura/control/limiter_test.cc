#include "flexura/control/limiter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/control/limiter_paths.h"
#include "flexura/kinematics/motion.h"
#include "flexura/kinematics/motors.h"
#include "flexura/kinematics/tendons.h"
#include "flexura/safety/contact_watch.h"
#include "flexura/safety/drive_check.h"
#include "flexura/safety/motion_check.h"
#include "tests/support/arms.h"
#include "tests/support/drives.h"

namespace flexura {
namespace {

using testing::HasSubstr;

// Returns spatial sections with finite values for all limits.
Arm limited_arm(TestRandom& random) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (int i = random.integer(1, 3); i > 0; --i) {
    Section& section = arm.sections.emplace_back();
    section.length = random.uniform(0.2, 0.5);
    section.radius = {0.02, 0.015};
    section.max_bend = random.uniform(0.5, 1.5);
    section.max_bend_rate = random.uniform(0.3, 2);
    if (random.integer(0, 1) == 1) section.stretch_limits = {0.9, 1.2};
    if (random.integer(0, 1) == 1) section.max_stretch_rate = random.uniform(0.1, 1);
  }
  return arm;
}

Drive limited_drive(TestRandom& random, const Arm& arm) {
  constexpr std::int64_t finer = 1'000'000'000;
  Drive drive = random_drive(random, arm);
  for (Axis& axis : drive.axes) {
    axis.spool.backlash = 0;  // Backlash compensation is up to the drive, and so is rounding.
    axis.motor.microsteps *= finer;
    axis.motor.max_speed = random.uniform(5, 60);
    axis.motor.max_acceleration = random.uniform(20, 400);
    axis.motor.max_step_rate = random.uniform(2000, 40000) * finer;
    axis.motor.max_position = axis.microsteps_a_metre() * random.uniform(0.01, 0.03);
  }
  if (random.integer(0, 3) == 0) drive.disks = 5;
  return drive;
}

// Returns commands of a law: a random walk, with jumps, beyond every limit at times.
ArmState next_request(TestRandom& random, const Arm& arm, const ArmState& before) {
  ArmState requested = before;
  const double size = random.integer(0, 9) == 0 ? 3 : 0.1;
  for (Eigen::Vector2d& bend : requested.bends) bend += size * random.vector<2>(-1, 1);
  for (std::size_t i = 0; i < arm.sections.size(); ++i)
    if (arm.sections[i].stretch_limits[0] < 1) requested.stretches[i] = random.uniform(0.7, 1.4);
  return requested;
}

// Returns all findings of a run's check in a sequence of commands.
SafetyReport judged(const Arm& arm, const LimiterConfig& config, const std::vector<ArmState>& sent) {
  std::vector<double> times, rows;
  times.reserve(sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) times.push_back(config.step * static_cast<double>(i));
  const MotionPtr motion = keyframe_motion(times, sent, Interpolation::linear);
  const double row = config.list_step > 0 ? config.list_step : config.step;
  for (int i = 0; i * row < times.back() * (1 + 1e-12); ++i) rows.push_back(std::min(i * row, times.back()));
  SafetyReport report =
      check_motions(arm, config.obstacles, sent.front(), {{motion, 0, "sent"}}, config.step);
  if (config.drive) {
    const auto state_at = [&](double t) { return motion->at(t); };
    const auto none = [](double, double) -> std::optional<std::vector<SectionRates>> { return std::nullopt; };
    check_drive(arm, *config.drive, state_at, rows, none, report);
  }
  return report;
}

void expect_safe(const SafetyReport& report) {
  for (const Violation& violation : report.violations) ADD_FAILURE() << violation.text();
}

void come_to_rest(CommandLimiter& limiter, std::vector<ArmState>& sent) {
  for (int i = 0; i < 300 && !limiter.is_at_rest(); ++i) sent.push_back(limiter.brake().state);
  EXPECT_TRUE(limiter.is_at_rest());
  sent.push_back(limiter.brake().state);
  sent.push_back(limiter.brake().state);
}

TEST(Limiter, SendsNothingThatBreaksALimitWhateverIsAskedFor) {
  int held_back = 0, moved = 0;
  for_random_cases(60, [&](TestRandom& random) {
    const Arm arm = limited_arm(random);
    LimiterConfig config{.step = random.uniform(0.01, 0.1), .looks_ahead = false};
    if (random.integer(0, 3) > 0) config.drive = limited_drive(random, arm);
    // A command list with a different clock.
    if (random.integer(0, 2) > 0) config.list_step = config.step * random.uniform(0.2, 3);
    const ArmState straight = ArmState::straight(arm.sections.size());
    CommandLimiter limiter(arm, config, straight);
    std::vector<ArmState> sent{straight};
    ArmState requested = straight;
    for (int i = 0; i < 60; ++i) {
      requested = next_request(random, arm, requested);
      const LimitedCommand command = limiter.next(requested);
      EXPECT_EQ(command.is_untouched, command.reason.empty());
      held_back += command.reason.empty() ? 0 : 1;
      for (std::size_t k = 0; k < requested.bends.size(); ++k)
        if (command.state.bends[k] != sent.back().bends[k]) ++moved;
      sent.push_back(command.state);
    }
    come_to_rest(limiter, sent);
    expect_safe(judged(arm, config, sent));
  });
  EXPECT_GT(held_back, 1000 / one_case_of);
  EXPECT_GT(moved, 1000 / one_case_of);
}

TEST(Limiter, KeepsOffObstaclesAndOffTheArmItself) {
  int stopped = 0;
  for_random_cases(8, [&](TestRandom& random) {
    Arm arm = limited_arm(random);
    for (Section& section : arm.sections) section.max_bend = 3, section.max_bend_rate = 3;
    LimiterConfig config{.step = 0.05};
    config.obstacles = obstacles({SphereConfig{.center = {0.18, 0.25, 0}, .radius = 0.06},
                                  PlaneConfig{.point = {0, 0, -0.1}, .normal = {0, 0, 1}}});
    const ArmState straight = ArmState::straight(arm.sections.size());
    CommandLimiter limiter(arm, config, straight);
    std::vector<ArmState> sent{straight};
    ArmState requested = straight;
    for (int i = 0; i < 40; ++i) {
      if (i % 10 == 0)
        for (Eigen::Vector2d& bend : requested.bends) bend = 2.5 * random.vector<2>(-1, 1);
      const LimitedCommand command = limiter.next(requested);
      if (command.reason.find("contact") != std::string::npos) ++stopped;
      sent.push_back(command.state);
    }
    come_to_rest(limiter, sent);
    expect_safe(judged(arm, config, sent));
  });
  EXPECT_GT(stopped, 0);
}

// With limits on bends and bend rates alone, each section's nearest command has a closed form where one limit
// holds it. A section within its limits gets its command.
TEST(Limiter, ChangesTheCommandAsLittleAsPossible) {
  for_random_cases(200, [](TestRandom& random) {
    Arm arm = limited_arm(random);
    for (Section& section : arm.sections) section.max_bend = 10, section.stretch_limits = {1, 1};
    const LimiterConfig config{.step = 0.05, .looks_ahead = false};
    const ArmState straight = ArmState::straight(arm.sections.size());
    CommandLimiter limiter(arm, config, straight);
    ArmState requested = straight;
    for (int i = 0; i < 5; ++i) {
      const ArmState before = limiter.sent();
      for (std::size_t k = 0; k < requested.bends.size(); ++k) {
        requested.bends[k] = before.bends[k] + random.uniform(0, 0.2) * random.vector<2>(-1, 1);
        if (arm.kind == ArmKind::planar) requested.bends[k].y() = 0;
      }
      const ArmState sent = limiter.next(requested).state;
      for (std::size_t k = 0; k < requested.bends.size(); ++k) {
        const Eigen::Vector2d way = requested.bends[k] - before.bends[k];
        const double most = arm.sections[k].max_bend_rate * config.step;
        const Eigen::Vector2d nearest = before.bends[k] + way * std::min(1.0, most / way.norm());
        EXPECT_LE((sent.bends[k] - nearest).norm(), 1e-6);
      }
    }
  });
}

// Along an obstacle the arm slides: it goes on in the directions in which nothing is in its way.
TEST(Limiter, SlidesAlongAnObstacle) {
  Arm arm;
  for (int i = 0; i < 2; ++i)
    arm.sections.push_back(
        {.length = 0.2, .radius = {0.01, 0.01}, .max_bend = 2, .max_bend_rate = 1, .stretch_limits = {1, 1}});
  LimiterConfig config{.step = 0.05};
  // The straight arm points along z. A wall beyond x = 0.06.
  config.obstacles = obstacles({PlaneConfig{.point = {0.06, 0, 0}, .normal = {-1, 0, 0}}});
  const ArmState straight = ArmState::straight(2);
  CommandLimiter limiter(ArmModel(arm), config, straight);
  const ArmState requested{{{0.9, 0.9}, {0.9, 0.9}}, {1, 1}};
  const ContactWatch wall(arm, config.obstacles.front());
  for (int i = 0; i < 100; ++i) {
    (void)limiter.next(requested);
    EXPECT_GE(wall.contact(limiter.sent()).clearance, -contact_tolerance);
  }
  EXPECT_LE(wall.contact(limiter.sent()).clearance, 0.005);
  const Backbone reached(arm, limiter.sent());
  EXPECT_GE(std::abs(reached.tip().position.y()), 0.15) << "it goes on along the wall";
}

TEST(Limiter, PassesWhatIsWithinTheLimitsBitForBit) {
  for_random_cases(20, [](TestRandom& random) {
    const Arm arm = limited_arm(random);
    LimiterConfig config{.step = 1.0 / 30};
    config.drive = limited_drive(random, arm);
    // A sine so small and slow that every motor follows it.
    const ArmState straight = ArmState::straight(arm.sections.size());
    CommandLimiter limiter(arm, config, straight);
    for (int i = 1; i < 90; ++i) {
      ArmState requested = straight;
      const double share = 0.004 * (1 - std::cos(0.05 * i));
      for (Eigen::Vector2d& bend : requested.bends) bend = Eigen::Vector2d(share, -0.3 * share);
      const LimitedCommand command = limiter.next(requested);
      EXPECT_TRUE(command.is_untouched) << command.reason;
      EXPECT_EQ(command.state.bends, requested.bends);
      EXPECT_EQ(command.state.stretches, requested.stretches);
    }
  });
}

TEST(Limiter, ArrivesAtAWishWithinTheLimits) {
  for_random_cases(20, [](TestRandom& random) {
    const Arm arm = limited_arm(random);
    LimiterConfig config{.step = 0.05, .looks_ahead = false};
    config.drive = limited_drive(random, arm);
    for (Axis& axis : config.drive->axes) {
      axis.motor.max_position = std::numeric_limits<double>::infinity();
    }
    ArmState requested = ArmState::straight(arm.sections.size());
    CommandLimiter limiter(arm, config, requested);
    for (Eigen::Vector2d& bend : requested.bends) bend = random.vector<2>(-0.3, 0.3);
    bool arrived = false;
    for (int i = 0; i < 3000 && !arrived; ++i) arrived = limiter.next(requested).is_at_rest;
    EXPECT_TRUE(arrived);
    EXPECT_EQ(limiter.sent().bends, requested.bends);
    EXPECT_TRUE(limiter.next(requested).is_untouched);
  });
}

// A law at this rate has way/(rate step) left. One of the motors must be as fast as it can still brake over
// that, with half of its acceleration, and none faster.
TEST(Limiter, GoesNoFasterThanItsMotorsBrakeInTheWayThatIsLeft) {
  int slowed = 0;
  for_random_cases(60, [&](TestRandom& random) {
    const Arm arm = limited_arm(random);
    LimiterConfig config{.step = random.uniform(0.01, 0.1), .looks_ahead = false};
    config.drive = limited_drive(random, arm);
    config.drive->disks.reset();
    const ArmState straight = ArmState::straight(arm.sections.size());
    const CommandLimiter limiter(arm, config, straight);
    ArmState requested = straight;
    for (Eigen::Vector2d& bend : requested.bends) bend = random.vector<2>(-0.3, 0.3);
    const double rate = random.uniform(1, 5);
    const ArmState slow = limiter.within_braking(requested, rate);
    const auto motors = [&](const ArmState& state) {
      return motor_positions(*config.drive, tendon_displacements(arm, *config.drive, state));
    };
    const std::vector<double> begun = motors(straight), far = motors(requested), near = motors(slow);
    double most = 0;
    for (std::size_t i = 0; i < begun.size(); ++i) {
      const double speed = std::abs(near[i] - begun[i]) / config.step;
      const double left = std::abs(far[i] - begun[i]) / (rate * config.step);
      const double braking = 0.5 * motor_acceleration(config.drive->axes[i].motor);
      most = std::max(most, speed * speed / (2 * braking * left));
    }
    const bool is_slowed = slow.bends != requested.bends;
    slowed += is_slowed ? 1 : 0;
    EXPECT_LE(most, 1 + 1e-6);
    EXPECT_GE(most, is_slowed ? 1 - 1e-6 : 0);
  });
  EXPECT_GT(slowed, 20 / one_case_of);
}

TEST(Limiter, StopsAtAFaultAndKeepsWhatWasKnown) {
  for_random_cases(30, [](TestRandom& random) {
    const Arm arm = limited_arm(random);
    LimiterConfig config{.step = 0.05, .looks_ahead = false};
    config.drive = limited_drive(random, arm);
    const ArmState straight = ArmState::straight(arm.sections.size());
    CommandLimiter limiter(arm, config, straight);
    std::vector<ArmState> sent{straight};
    ArmState requested = straight, seen = straight;
    for (Eigen::Vector2d& bend : requested.bends) bend = random.vector<2>(-2, 2);
    for (int i = 0; i < 6; ++i) sent.push_back(limiter.next(requested).state);
    seen.bends[0] = {0.123, 0};
    limiter.observe(seen);
    const int kind = random.integer(0, 3);
    ArmState bad = requested;
    if (kind == 0) bad.bends[0].x() = std::nan("");
    if (kind == 1) bad.stretches[0] = std::numeric_limits<double>::infinity();
    if (kind == 2) bad.bends.emplace_back(0, 0);
    if (kind == 3) limiter.fault("link lost: camera front");
    const ArmState before = limiter.sent();
    sent.push_back(limiter.next(bad).state);
    ASSERT_TRUE(limiter.fault().has_value());
    EXPECT_THAT(limiter.fault()->reason, HasSubstr(kind < 2    ? "finite"
                                                   : kind == 2 ? "this arm"
                                                               : "link lost"));
    EXPECT_NEAR(limiter.fault()->time, 0.3, 1e-12);
    EXPECT_EQ(limiter.fault()->sent.bends, before.bends);
    EXPECT_EQ(limiter.fault()->observed->bends, seen.bends);
    EXPECT_EQ(limiter.fault()->asked->bends.size(),
              kind == 2 ? requested.bends.size() + 1 : requested.bends.size());
    // For any commands of the law, the arm must come to rest, within all limits, and stay.
    for (int i = 0; i < 300 && !limiter.is_at_rest(); ++i) {
      EXPECT_THROW(limiter.reset(), std::logic_error);
      sent.push_back(limiter.next(requested).state);
    }
    const ArmState rest = limiter.sent();
    for (int i = 0; i < 3; ++i) {
      const LimitedCommand command = limiter.next(requested);
      EXPECT_TRUE(command.is_at_rest);
      EXPECT_EQ(command.state.bends, rest.bends);
      EXPECT_FALSE(command.reason.empty());
      sent.push_back(command.state);
    }
    expect_safe(judged(arm, config, sent));
    limiter.reset();
    EXPECT_FALSE(limiter.fault().has_value());
    EXPECT_NE(limiter.next(requested).state.bends, rest.bends);
  });
}

TEST(Limiter, SaysWhatHeldTheLawBack) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  Section& section = arm.sections.emplace_back();
  section.length = 0.4, section.max_bend = 1, section.max_bend_rate = 0.5;
  const ArmState straight = ArmState::straight(1);
  CommandLimiter limiter(arm, {.step = 0.1, .looks_ahead = false}, straight);
  EXPECT_THAT(limiter.next({{{0.2, 0}}, {1}}).reason, HasSubstr("section 1: bend rate"));
  EXPECT_NEAR(limiter.sent().bends[0].x(), 0.05, 1e-3);
  EXPECT_LE(limiter.sent().bends[0].x(), 0.05 * (1 + 1e-9));
  for (int i = 0; i < 30; ++i) (void)limiter.next({{{2, 0}}, {1}});
  EXPECT_NEAR(limiter.sent().bends[0].x(), 1, 1e-3);
  EXPECT_THAT(limiter.next({{{2, 0}}, {1}}).reason, HasSubstr("bend at its limit"));
  EXPECT_THAT(limiter.next({{{0.96, 0}}, {1.1}}).reason, HasSubstr("stretch at its limit"));
}

TEST(Limiter, StartsWithinTheLimitsOnly) {
  Arm arm;
  arm.sections.emplace_back().max_bend = 1;
  EXPECT_THROW(CommandLimiter(arm, {}, ArmState::straight(2)), std::invalid_argument);
  EXPECT_THROW(CommandLimiter(arm, {}, {{{1.1, 0}}, {1}}), std::invalid_argument);
  EXPECT_THROW(CommandLimiter(arm, {.step = 0}, ArmState::straight(1)), std::invalid_argument);
  LimiterConfig lamp;
  lamp.obstacles = obstacles({SphereConfig{.center = {0, 0.5, 0}, .radius = 0.1}});
  EXPECT_THROW(CommandLimiter(arm, lamp, ArmState::straight(1)), std::invalid_argument);
  lamp.looks_ahead = false;
  EXPECT_NO_THROW(CommandLimiter(arm, lamp, ArmState::straight(1)));
  CommandLimiter limiter(arm, {}, ArmState::straight(1));
  EXPECT_THAT(limiter.next({{{0.1, 0.1}}, {1}}).reason, HasSubstr("out of the arm's plane"));
}

// An arm that starts nearer to a motor's stop than backlash and rounding of the list must be moved away from
// it, and not back.
TEST(Limiter, BeginsAtAMotorsStopAndGoesNoNearer) {
  for_random_cases(20, [](TestRandom& random) {
    Arm arm;
    arm.kind = ArmKind::spatial;
    arm.sections.resize(3, {.length = 0.3, .radius = {0.02, 0.02}});
    ArmState start = ArmState::straight(3);
    for (Eigen::Vector2d& bend : start.bends) bend = random.vector<2>(-0.5, 0.5);
    LimiterConfig config{.step = 0.05, .looks_ahead = false};
    config.drive = random_drive(random, arm);
    const auto motors = [&](const ArmState& state) {
      return motor_positions(*config.drive, tendon_displacements(arm, *config.drive, state));
    };
    const std::vector<double> begun = motors(start);
    const double share = random.uniform(0, 1);
    for (std::size_t i = 0; i < begun.size(); ++i) {
      Axis& axis = config.drive->axes[i];
      axis.motor.max_position = std::abs(begun[i]) + share * (axis.backlash_steps() + 0.5);
    }
    CommandLimiter limiter(arm, config, start);
    ArmState farther = start, back = start;
    for (std::size_t i = 0; i < 3; ++i) farther.bends[i] *= 1.5, back.bends[i] *= 0.5;
    const auto least_left = [&](const ArmState& state) {
      const std::vector<double> now = motors(state);
      double left = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < now.size(); ++i)
        left = std::min(left, std::abs(begun[i]) - std::abs(now[i]));
      return left;
    };
    const auto steer = [&](const ArmState& requested) {
      ArmState sent;
      for (int i = 0; i < 100; ++i) {
        sent = limiter.next(requested).state;
        EXPECT_GE(least_left(sent), -1e-6);
      }
      return least_left(sent);
    };
    steer(farther);
    EXPECT_GT(steer(back), 0);
    steer(farther);
    config.drive->axes[0].motor.max_position = 0.9 * std::abs(begun[0]);
    EXPECT_THROW(CommandLimiter(arm, config, start), std::invalid_argument);
  });
}

}  // namespace
}  // namespace flexura
