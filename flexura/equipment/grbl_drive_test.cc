#include "flexura/equipment/grbl_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/base/table.h"
#include "tests/support/fault_of.h"
#include "tests/support/grbl_bench.h"

namespace flexura {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Positions = std::vector<double>;

TEST(GrblDrive, MovesAllAxesTogetherInTheDuration) {
  GrblBench bench;
  ASSERT_EQ(fault_of(bench.start()), "");
  EXPECT_EQ(bench.drive->axes(), 3U);
  EXPECT_EQ(bench.drive->quantity(), DriveQuantity::motor_positions);
  const double start = bench.clock.now();
  ASSERT_EQ(fault_of(bench.drive->command(Positions{3000, -1500, 7}, 1)), "");
  bench.link->pass(start + 0.5 - bench.clock.now());
  const DriveReading half = bench.drive->read().value();
  EXPECT_TRUE(half.moving);
  EXPECT_NEAR(half.values[0], 1500, 40);
  EXPECT_NEAR(half.values[1], -750, 20);
  EXPECT_NEAR(half.time, bench.clock.now(), 0.02);
  bench.link->pass(start + 0.98 - bench.clock.now());
  EXPECT_TRUE(bench.drive->read().value().moving);
  bench.link->pass(start + 1.03 - bench.clock.now());
  const DriveReading end = bench.drive->read().value();
  EXPECT_FALSE(end.moving);
  EXPECT_THAT(end.values, ElementsAre(3000, -1500, 7));
  EXPECT_THAT(bench.motors(), ElementsAre(3000, -1500, 7));
}

TEST(GrblDrive, MovesAsSoonAsPossibleIfTheDurationIsTooShort) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  for (const double duration : {0.0, 0.01}) {
    const double start = bench.clock.now();
    const double target = duration == 0 ? 5000 : 0;
    ASSERT_TRUE(bench.drive->command(Positions{target, 0, 0}, duration));
    while (bench.drive->read().value().moving) {
    }
    EXPECT_NEAR(bench.clock.now() - start, 0.6, 0.03);
    EXPECT_EQ(bench.motors()[0], target);
    bench.link->pass(1);
  }
}

// A target moves on a circle; commands come 30 times a second, as those of a servo.
TEST(GrblDrive, FollowsAStreamOfCommandsWithoutStops) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  constexpr double period = 1.0 / 30, turn = 4;  // s
  const auto wanted = [&](double time) {
    const double angle = 2 * std::numbers::pi * time / turn;
    return Positions{1500 - 1500 * std::cos(angle), 1500 * std::sin(angle), 500 * std::sin(angle)};
  };
  const double start = bench.clock.now();
  double slowest = std::numeric_limits<double>::infinity(), largest_error = 0;
  Positions before = bench.motors();
  double sampled_at = start;
  for (int i = 0; i < 120; ++i) {
    const double next = start + period * (i + 1);
    ASSERT_EQ(fault_of(bench.drive->command(wanted(period * (i + 1)), period)), "");
    while (bench.clock.now() < next) {
      bench.link->pass(std::min(0.011, next - bench.clock.now()));
      const Positions now = bench.motors();
      const double elapsed = bench.clock.now() - sampled_at;
      if (elapsed < 0.01) continue;
      const double speed = std::hypot(now[0] - before[0], now[1] - before[1]) / elapsed;
      if (i > 15) {
        slowest = std::min(slowest, speed);
        // The delay is the lead and half of the time for a call.
        const Positions ideal = wanted(bench.clock.now() - start - GrblConfig().lead);
        for (std::size_t k = 0; k < 3; ++k)
          largest_error = std::max(largest_error, std::abs(now[k] - ideal[k]));
      }
      before = now, sampled_at = bench.clock.now();
    }
    ASSERT_EQ(fault_of(bench.drive->read()), "");
  }
  constexpr double speed = 2 * std::numbers::pi * 1500 / turn;  // steps/s
  EXPECT_GT(slowest, 0.8 * speed);
  EXPECT_LT(largest_error, 0.02 * speed);
  bench.link->pass(0.5);
  EXPECT_FALSE(bench.drive->read().value().moving);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(bench.motors()[k], std::round(wanted(4)[k]));
}

TEST(GrblDrive, ReplacesALongMotion) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.drive->command(Positions{10000, 0, 0}, 10));
  bench.link->pass(1);
  ASSERT_EQ(fault_of(bench.drive->command(Positions{0, 200, 0}, 1)), "");
  bench.link->pass(0.5);
  EXPECT_LT(bench.motors()[0], 1000);
  bench.link->pass(1);
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(0, 200, 0));
}

TEST(GrblDrive, HaltsInMidMotionAndGoesOn) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.drive->command(Positions{10000, 0, 0}, 2));
  bench.link->pass(1);
  ASSERT_EQ(fault_of(bench.drive->halt()), "");
  const Positions stopped = bench.motors();
  EXPECT_LT(stopped[0], 7000);
  EXPECT_EQ(bench.drive->read().value().values, stopped);
  EXPECT_FALSE(bench.drive->read().value().moving);
  ASSERT_TRUE(bench.drive->command(Positions{0, 0, 0}, 2));
  bench.link->pass(2.1);
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(0, 0, 0));
  EXPECT_EQ(fault_of(bench.drive->halt()), "");
}

TEST(GrblDrive, RefusesBadCommandsAndClampsTargets) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  GrblConfig config;
  config.travel = 5000;
  GrblBench bench({}, config);
  EXPECT_EQ(fault_of(bench.drive->command(Positions{0, 0, 0}, 1)), "refused: board: not connected");
  ASSERT_TRUE(bench.drive->connect());
  EXPECT_EQ(fault_of(bench.drive->command(Positions{0, 0, 0}, 1)),
            "refused: board: the position is unknown: home the controller or set its position");
  EXPECT_FALSE(bench.drive->read());
  ASSERT_TRUE(bench.drive->set_positions(Positions{0, 100, 0}));
  EXPECT_FALSE(bench.drive->command(Positions{0, 0}, 1));
  EXPECT_FALSE(bench.drive->command(Positions{0, 0, nan}, 1));
  EXPECT_FALSE(bench.drive->command(Positions{0, 0, 0}, -1));
  EXPECT_FALSE(bench.drive->command(Positions{0, 0, 0}, nan));
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(0, 100, 0));
  ASSERT_TRUE(bench.drive->command(Positions{1e9, 100.4, -1e9}, 0));
  bench.link->pass(3);
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(5000, 100, -5000));
  EXPECT_THROW(GrblDrive(nullptr, bench.clock, {.axes = "YX"}), std::invalid_argument);
}

TEST(GrblDrive, HomesWithinSoftLimits) {
  GrblDeviceConfig board{.settings = {{20, 1}, {22, 1}, {23, 2}, {24, 300}, {25, 3000}}};
  board.low = {-19000, -4000, -19000};
  board.high = {3000, 19000, 5000};
  GrblBench bench(board);
  ASSERT_EQ(fault_of(bench.drive->connect()), "");
  EXPECT_THAT(fault_of(bench.drive->set_positions(Positions{0, 0, 0})), HasSubstr("in alarm"));
  ASSERT_EQ(fault_of(bench.drive->home(Positions{100, -200, 300})), "");
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(100, -200, 300));
  // Travel is 200 mm from the switch; homing leaves 1 mm.
  ASSERT_EQ(fault_of(bench.drive->command(Positions{1e6, -1e6, 0}, 0)), "");
  bench.link->pass(2);
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(200, -300, 0));
}

TEST(GrblDrive, SaysWhyHomingFails) {
  GrblBench without;
  ASSERT_TRUE(without.start());
  EXPECT_EQ(fault_of(without.drive->home(Positions{0, 0, 0})),
            "refused: board: homing failed: error 5 (homing is not enabled (setting $22))");
  GrblBench missing({.settings = {{22, 1}, {25, 6000}}});
  ASSERT_TRUE(missing.drive->connect());
  EXPECT_EQ(fault_of(missing.drive->home(Positions{0, 0, 0})),
            "refused: board: homing failed: alarm 9 (homing found no limit switch)");
  EXPECT_FALSE(missing.drive->knows_position());
}

TEST(GrblDrive, LosesItsPositionByAnAlarmInMidMotion) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.drive->command(Positions{9000, 0, 0}, 2));
  bench.link->pass(1);
  bench.device.raise_alarm(1, bench.clock.now());
  bench.link->pass(0.01);
  EXPECT_EQ(fault_of(bench.drive->read()),
            "refused: board: the controller is in alarm 1 (a limit switch was hit in motion, the position is "
            "lost): "
            "clear its cause and unlock it, then home it or set its position");
  EXPECT_FALSE(bench.drive->command(Positions{0, 0, 0}, 1));
  EXPECT_TRUE(bench.drive->halt());
  ASSERT_EQ(fault_of(bench.drive->unlock()), "");
  EXPECT_THAT(fault_of(bench.drive->command(Positions{0, 0, 0}, 1)), HasSubstr("position is unknown"));
  ASSERT_TRUE(bench.drive->set_positions(Positions{5, 6, 7}));
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(5, 6, 7));
}

TEST(GrblDrive, LosesItsPositionByARestart) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.drive->command(Positions{9000, 0, 0}, 2));
  bench.link->pass(1);
  bench.device.restart(bench.clock.now());
  bench.link->pass(0.1);
  EXPECT_THAT(fault_of(bench.drive->read()), HasSubstr("position"));
  EXPECT_FALSE(bench.drive->knows_position());
  EXPECT_FALSE(bench.drive->command(Positions{0, 0, 0}, 1));
}

TEST(GrblDrive, ReportsAMotionThatIsNotExecuted) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  bench.device.set_ignores_motions(true);
  ASSERT_TRUE(bench.drive->command(Positions{900, 0, 0}, 1));
  EXPECT_EQ(fault_of(bench.drive->read()),
            "refused: board: the motors were commanded to 900, 0, 0 but stand at 0, 0, 0 (steps of the "
            "controller): the controller has not executed the motion");
  bench.device.set_ignores_motions(false);
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(0, 0, 0));
}

TEST(GrblDrive, ChecksAndCorrectsSettings) {
  GrblBench wrong({.settings = {{1, 25}, {10, 2}, {13, 1}}});
  EXPECT_EQ(
      fault_of(wrong.drive->connect()),
      "refused: board: setting $1 is 25; the motors must hold the tendons when they rest: send $1=255 to the "
      "controller, or allow writes_settings");
  GrblConfig config;
  config.writes_settings = true;
  GrblBench corrected({.settings = {{1, 25}, {10, 2}, {13, 1}}}, config);
  ASSERT_EQ(fault_of(corrected.start()), "");
  EXPECT_EQ(corrected.device.setting(1), 255);
  EXPECT_EQ(corrected.device.setting(10), 3);
  EXPECT_EQ(corrected.device.setting(13), 0);
  EXPECT_THAT(fault_of(GrblBench({.settings = {{101, 800}}}).drive->connect()),
              HasSubstr("setting $101 is 800 steps/mm; expected above 0, at most 500"));
  config.axes = "XYZA";
  EXPECT_THAT(fault_of(GrblBench({}, config).drive->connect()), HasSubstr("setting $103 is 0"));
}

TEST(GrblDrive, WaitsForABoardThatStartsAndGivesUpOnNone) {
  GrblBench slow({.boot_time = 2});
  slow.device.restart(slow.clock.now());
  EXPECT_EQ(fault_of(slow.start()), "");
  GrblBench silent;
  ASSERT_TRUE(silent.start());
  silent.link->is_silent = true;
  const double start = silent.clock.now();
  EXPECT_THAT(fault_of(silent.drive->command(Positions{1, 0, 0}, 1)), HasSubstr("does not answer"));
  EXPECT_THAT(fault_of(silent.drive->read()), HasSubstr("does not answer"));
  EXPECT_FALSE(silent.drive->halt());
  EXPECT_THAT(fault_of(silent.drive->connect()), HasSubstr("no controller with Grbl answers within 5 s"));
  EXPECT_LT(silent.clock.now() - start, 20);
}

TEST(GrblDrive, DrivesSixAxesOfGrblhal) {
  GrblConfig config;
  config.axes = "XYAC";
  GrblBench bench({.axes = 6, .is_grblhal = true}, config);
  ASSERT_EQ(fault_of(bench.start()), "");
  ASSERT_TRUE(bench.drive->command(Positions{1, 2, 3, 4}, 0));
  bench.link->pass(0.5);
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(bench.motors(), ElementsAre(1, 2, 0, 3, 0, 4));
}

TEST(GrblDrive, EndsAHoldWithoutLosingThePosition) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  (void)bench.device.receive("!", bench.clock.now());
  EXPECT_EQ(fault_of(bench.drive->read()), "refused: board: the controller is in the state Hold: unlock it");
  ASSERT_EQ(fault_of(bench.drive->unlock()), "");
  EXPECT_THAT(bench.drive->read().value().values, ElementsAre(0, 0, 0));
}

TEST(GrblDrive, IsStoppedByStopMessagesInAnyState) {
  const StopMessages stop = grbl_stop({});
  ASSERT_EQ(stop.first.size(), 1U);
  ASSERT_EQ(stop.then.size(), 1U);
  for (const std::string line : {"$J=G90X100F6000\n", "G1X100F6000\n"}) {
    GrblBench bench;
    ASSERT_TRUE(bench.start());
    (void)bench.device.receive(line, bench.clock.now());
    bench.link->pass(0.3);
    (void)bench.device.receive(stop.first[0], bench.clock.now());
    bench.link->pass(stop.delay);
    const Positions braked = bench.motors();
    (void)bench.device.receive(stop.then[0], bench.clock.now());
    bench.link->pass(1);
    EXPECT_EQ(bench.motors(), braked);
    EXPECT_EQ(bench.device.state(), GrblState::idle);
    EXPECT_FALSE(bench.drive->read());
  }
}

TEST(GrblDrive, HaltsAMotionThatBrakesLongerThanAnAnswerTakes) {
  GrblBench bench({.settings = {{120, 50}}});
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.drive->command(Positions{20000, 0, 0}, 0));
  bench.link->pass(1.5);
  ASSERT_EQ(fault_of(bench.drive->halt()), "");
  EXPECT_EQ(bench.drive->read().value().values, bench.motors());
}

TEST(GrblConfig, HasATableOfFields) {
  const TableInfo& info = fields_of(static_cast<const GrblConfig*>(nullptr)).info();
  EXPECT_EQ(info.fields.size(), 12U);
}

TEST(GrblSession, KeepsTheWindow) {
  SteppedClock clock;
  GrblDevice device;
  SteppedLink link(device, clock);
  GrblSession session(link, clock, 128, 2);
  ASSERT_TRUE(session.reset(5));
  std::vector<std::string> lines;
  lines.reserve(100);
  for (int i = 0; i < 100; ++i) lines.push_back("G1X" + std::to_string(i % 3) + "F6000\n");
  EXPECT_EQ(session.stream(lines).value(), 0);
  EXPECT_EQ(device.lost_bytes(), 0U);
  EXPECT_EQ(session.unanswered(), 0U);
  EXPECT_EQ(session.stream(std::vector<std::string>{"G4P0\n", "G2\n", "$\n"}).value(), 20);
}

}  // namespace
}  // namespace flexura
