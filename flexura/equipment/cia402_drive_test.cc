#include "flexura/equipment/cia402_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/cia402_loop.h"
#include "tests/support/fault_of.h"

namespace flexura {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Cia402Drive, SetsDrivesUpAndKnowsTheirNames) {
  Cia402Bench bench(2);
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  EXPECT_EQ(bench.device.node(0).state(), DriveState::operation_enabled);
  EXPECT_EQ(bench.device.node(1).nmt_state(), NmtState::operational);
  const auto identities = bench.drive.identities();
  EXPECT_EQ(identities[0].name, "Flexura simulated stepper");
  EXPECT_EQ(identities[1].product, 0x402U);
  EXPECT_THAT(identities[0].notes, ElementsAre());
  EXPECT_THAT(bench.positions(), ElementsAre(0, 0));
}

TEST(Cia402Drive, MovesAllAxesSoThatTheyArriveTogether) {
  Cia402Bench bench(4);
  ASSERT_TRUE(bench.drive.start());
  const std::vector<double> targets{1000, -2000, 30, 0};
  const double begin = bench.clock.time;
  ASSERT_EQ(fault_of(bench.drive.command(targets, 2)), "");
  EXPECT_TRUE(bench.drive.read().value().moving);
  bench.bus.pass(begin + 1 - bench.clock.time);
  EXPECT_NEAR(bench.positions()[0], 500, 10);
  EXPECT_NEAR(bench.positions()[1], -1000, 20);
  EXPECT_NEAR(bench.positions()[2], 15, 1);
  bench.bus.pass(0.9);
  EXPECT_TRUE(bench.drive.read().value().moving);
  bench.bus.pass(0.2);
  const DriveReading reading = bench.drive.read().value();
  EXPECT_FALSE(reading.moving);
  EXPECT_EQ(reading.values, targets);
  EXPECT_NEAR(reading.time, bench.clock.time, 0.01);
  EXPECT_EQ(bench.positions(), targets);
}

TEST(Cia402Drive, ReplacesATargetInMidMove) {
  Cia402Bench bench(1);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_TRUE(bench.drive.command(std::vector{4000.0}, 2));
  bench.bus.pass(1);
  const double before = bench.positions()[0];
  EXPECT_GT(before, 1000);
  ASSERT_EQ(fault_of(bench.drive.command(std::vector{-100.0}, 1)), "");
  bench.bus.pass(1.1);
  EXPECT_EQ(bench.drive.read().value().values[0], -100);
  EXPECT_FALSE(bench.drive.read().value().moving);
}

TEST(Cia402Drive, FollowsCommandsThirtyTimesPerSecond) {
  Cia402Bench bench(4);
  ASSERT_TRUE(bench.drive.start());
  const double begin = bench.clock.time;
  const std::size_t written = bench.bus.written;
  for (int i = 1; i <= 60; ++i) {
    const double target = 500 * std::sin(i / 20.0);
    ASSERT_EQ(fault_of(bench.drive.command(std::vector(4, target), 1 / 30.0)), "");
    const DriveReading reading = bench.drive.read().value();
    EXPECT_NEAR(reading.values[0], target, 60);
    // Neither the bus nor the drives take more than the period.
    ASSERT_LT(bench.clock.time, begin + i / 30.0);
    bench.bus.pass(begin + i / 30.0 - bench.clock.time);
  }
  EXPECT_LE(bench.bus.written - written, 60U * 21);
}

TEST(Cia402Drive, StartMovesNothingThoughATargetArrivedLate) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_TRUE(bench.drive.command(std::vector{1000.0, -500.0}, 2));
  bench.bus.pass(0.5);
  ASSERT_TRUE(bench.drive.halt());
  bench.bus.pass(0.5);
  const std::vector<double> before = bench.positions();
  // The cable was out, and the interface sends its last frames now: RPDO 1 with a new setpoint of 2000.
  for (std::uint32_t node = 1; node <= 2; ++node) {
    const CanFrame late{.id = cob::rpdo1 + node, .size = 6, .data = {0x3F, 0, 0xD0, 0x07, 0, 0}};
    (void)bench.device.receive(bytes_of(late), bench.clock.time);
  }
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  bench.bus.pass(1);
  EXPECT_EQ(bench.positions(), before);
}

// A node ignores PDOs until it is operational.
TEST(Cia402Drive, StartRepeatsTheCommandThatMakesNodesOperational) {
  Cia402Bench bench(2);
  int lost = 0;
  bench.bus.passes = [&](const CanFrame& frame) {
    const bool is_lost = frame.id == cob::nmt && frame.data[0] == 1 && frame.data[1] == 2 && lost < 3;
    lost += is_lost ? 1 : 0;
    return !is_lost;
  };
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  EXPECT_EQ(lost, 3);
  bench.bus.passes = [](const CanFrame& frame) {
    return frame.id != cob::nmt || frame.data[0] != 1 || frame.data[1] != 2;
  };
  EXPECT_THAT(fault_of(bench.drive.start()), HasSubstr("axis 2 (node 2) does not become operational"));
}

TEST(Cia402Drive, ALostSpeedIsSentAgain) {
  Cia402Bench bench(1);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_TRUE(bench.drive.command(std::vector{1000.0}, 0.5));  // Fast.
  bench.bus.pass(1);
  int lost = 0;
  bench.bus.passes = [&](const CanFrame& frame) { return frame.id != cob::rpdo2 + 1 || ++lost != 1; };
  ASSERT_TRUE(bench.drive.command(std::vector{0.0}, 4));
  EXPECT_GT(lost, 1);
  bench.bus.pass(2);
  EXPECT_NEAR(bench.positions()[0], 500, 30);
}

TEST(Cia402Drive, StartEndsTheMotionOfAProgramThatDied) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_TRUE(bench.drive.command(std::vector{4000.0, -4000.0}, 10));
  bench.bus.pass(1);
  Cia402Drive next(bench.bus, bench.clock, bench.config);
  ASSERT_EQ(fault_of(next.start()), "");
  bench.bus.pass(0.5);
  const std::vector<double> before = bench.positions();
  EXPECT_LT(before[0], 3000);
  bench.bus.pass(1);
  EXPECT_EQ(bench.positions(), before);
}

TEST(Cia402Drive, AFailedHaltNeedsAStart) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  bench.bus.is_silent = true;
  EXPECT_FALSE(bench.drive.halt());
  bench.bus.is_silent = false;
  EXPECT_THAT(fault_of(bench.drive.command(std::vector{10.0, 10.0}, 1)), HasSubstr("must be started"));
  EXPECT_FALSE(bench.drive.read());
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  EXPECT_TRUE(bench.drive.read());
}

TEST(Cia402Drive, ConvertsUnitsAndKeepsLimits) {
  Cia402Config config;
  config.axes.resize(1);
  config.axes[0] = {.limits = {-100, 400},
                    .max_rate = 1000,
                    .position_unit = -10,
                    .velocity_unit = 10,
                    .acceleration_unit = 10};
  Cia402Bench bench(1, 1, config);
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  ASSERT_TRUE(bench.drive.command(std::vector{900.0}, 1));
  bench.bus.pass(1.1);
  EXPECT_EQ(bench.drive.read().value().values[0], 400);
  EXPECT_EQ(bench.positions()[0], -4000);
}

TEST(Cia402Drive, RefusesWrongCommands) {
  Cia402Bench bench(2);
  EXPECT_THAT(fault_of(bench.drive.command(std::vector{0.0, 0.0}, 1)), HasSubstr("must be started"));
  ASSERT_TRUE(bench.drive.start());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(fault_of(bench.drive.command(std::vector{0.0}, 1)), HasSubstr("1 targets for 2 axes"));
  EXPECT_THAT(fault_of(bench.drive.command(std::vector{0.0, nan}, 1)), HasSubstr("not finite"));
  EXPECT_THAT(fault_of(bench.drive.command(std::vector{0.0, 0.0}, -1)), HasSubstr("not negative"));
  EXPECT_THAT(fault_of(bench.drive.command(std::vector{0.0, 0.0}, nan)), HasSubstr("not negative"));
  EXPECT_THAT(bench.positions(), Each(0));
  EXPECT_THROW(Cia402Drive(bench.bus, bench.clock, Cia402Config{}), std::invalid_argument);
}

TEST(Cia402Drive, HaltsWithItsMotorsOnAndGoesOnLater) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_TRUE(bench.drive.command(std::vector{4000.0, -4000.0}, 2));
  bench.bus.pass(1);
  ASSERT_EQ(fault_of(bench.drive.halt()), "");
  EXPECT_EQ(bench.device.node(0).state(), DriveState::quick_stop_active);
  bench.bus.pass(0.1);
  const double stopped = bench.positions()[0];
  EXPECT_LT(stopped, 2500);
  bench.bus.pass(0.5);
  EXPECT_EQ(bench.positions()[0], stopped);
  const DriveReading reading = bench.drive.read().value();
  EXPECT_FALSE(reading.moving);
  EXPECT_NEAR(reading.values[0], stopped, 0.5);
  ASSERT_EQ(fault_of(bench.drive.command(std::vector{0.0, 0.0}, 1)), "");
  bench.bus.pass(1.1);
  EXPECT_THAT(bench.drive.read().value().values, ElementsAre(0, 0));
}

TEST(Cia402Drive, HomesAxesOneAfterTheOther) {
  Cia402Config config;
  config.axes.resize(3);
  config.axes[0] = {.node = 1, .limits = {-5000, 5000}, .homing_method = 17, .home = 50};
  config.axes[1] = {.node = 2, .limits = {-5000, 5000}, .homing_method = 35, .home = -7};
  config.axes[2] = {.node = 3, .limits = {-5000, 5000}};
  Cia402Bench bench(3, 1, config);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_EQ(fault_of(bench.drive.home()), "");
  EXPECT_THAT(bench.drive.read().value().values, ElementsAre(50, -7, 0));
  ASSERT_EQ(fault_of(bench.drive.command(std::vector{100.0, 100.0, 100.0}, 1)), "");
  bench.bus.pass(1.1);
  EXPECT_THAT(bench.drive.read().value().values, ElementsAre(100, 100, 100));
}

TEST(Cia402Drive, ReportsFailedHoming) {
  Cia402Config config;
  config.axes = {{.homing_method = 17}};
  config.homing_timeout = 0.5;
  Cia402Bench bench(1, 1, config);
  ASSERT_TRUE(bench.drive.start());
  // 300 microsteps at 2000 per second are quick enough; the motor is blocked.
  bench.device.node(0).set_defect(Cia402Defect::ignores_targets, bench.clock.time);
  EXPECT_THAT(fault_of(bench.drive.home()), HasSubstr("axis 1 (node 1) cannot home by method 17"));
  // In homing mode a target would start the homing again.
  EXPECT_THAT(fault_of(bench.drive.command(std::vector{0.0}, 1)), HasSubstr("must be started (again)"));
  EXPECT_EQ(fault_of(bench.drive.halt()), "");
  bench.device.node(0).set_defect(Cia402Defect::none, bench.clock.time);
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  EXPECT_EQ(fault_of(bench.drive.command(std::vector{0.0}, 1)), "");
}

TEST(Cia402Drive, ReportsAFaultInMidMoveAndRecovers) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_TRUE(bench.drive.command(std::vector{4000.0, 4000.0}, 2));
  bench.bus.pass(0.5);
  bench.device.node(1).fail(0x3220, bench.clock.time);
  bench.bus.pass(0.1);
  EXPECT_THAT(fault_of(bench.drive.read()), HasSubstr("axis 2 (node 2) has a fault: undervoltage"));
  EXPECT_THAT(fault_of(bench.drive.command(std::vector{0.0, 0.0}, 2)), HasSubstr("must be started (again)"));
  EXPECT_EQ(fault_of(bench.drive.halt()), "");
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  ASSERT_EQ(fault_of(bench.drive.command(std::vector{0.0, 0.0}, 1)), "");
  bench.bus.pass(1.1);
  EXPECT_THAT(bench.drive.read().value().values, ElementsAre(0, 0));
}

TEST(Cia402Drive, FindsDrivesThatDoNotMove) {
  for (const auto& [defect, words] :
       {std::pair{Cia402Defect::lies, "says that it has reached its target 1000"},
        std::pair{Cia402Defect::ignores_targets, "has accepted the target 1000 microsteps, but stands still"},
        std::pair{Cia402Defect::blocked, "following error"}}) {
    Cia402Config config;
    config.axes.resize(1);
    config.axes[0].following_window = 500;
    Cia402Bench bench(1, 1, config);
    ASSERT_TRUE(bench.drive.start());
    bench.device.node(0).set_defect(defect, bench.clock.time);
    ASSERT_TRUE(bench.drive.command(std::vector{1000.0}, 0.5));
    std::string fault;
    for (int i = 0; i < 50 && fault.empty(); ++i) {
      bench.bus.pass(0.05);
      const auto reading = bench.drive.read();
      fault = fault_of(reading);
      if (reading) {
        EXPECT_EQ(reading.value().values[0], 0);
      }
    }
    EXPECT_THAT(fault, HasSubstr(words));
    EXPECT_THAT(fault, Not(HasSubstr("\n")));
  }
}

TEST(Cia402Drive, ReportsDrivesThatCannotBeSetUp) {
  {
    Cia402Bench bench(1);
    bench.device.node(0).set_defect(Cia402Defect::keeps_mapping, 0);
    EXPECT_THAT(fault_of(bench.drive.start()), HasSubstr("refuses 0 for object 0x1600"));
  }
  {
    Cia402Bench bench(1);
    bench.device.node(0).set_defect(Cia402Defect::refuses_power, 0);
    EXPECT_THAT(fault_of(bench.drive.start()),
                HasSubstr("does not switch its motor on and stays in \"switched on\""));
  }
  Cia402Bench bench(2);
  bench.device.set_connected(1, false);
  EXPECT_THAT(fault_of(bench.drive.start()),
              HasSubstr("link lost: can:loop: axis 2 (node 2) does not answer"));
}

TEST(Cia402Drive, ReportsARestartAndALostBus) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  bench.bus.is_silent = true;
  EXPECT_THAT(fault_of(bench.drive.read()),
              HasSubstr("link lost: can:loop: axis 1 (node 1) does not answer"));
  EXPECT_FALSE(bench.drive.halt());
  bench.bus.is_silent = false;
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  EXPECT_EQ(fault_of(bench.drive.read()), "");
  bench.device.node(1).restart();
  bench.bus.pass(0.01);
  EXPECT_THAT(fault_of(bench.drive.read()), HasSubstr("axis 2 (node 2) has restarted"));
  EXPECT_THAT(fault_of(bench.drive.read()), HasSubstr("must be started"));
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  EXPECT_EQ(fault_of(bench.drive.read()), "");
}

TEST(Cia402Drive, SwitchesMotorsOff) {
  Cia402Bench bench(2);
  ASSERT_TRUE(bench.drive.start());
  ASSERT_EQ(fault_of(bench.drive.release()), "");
  EXPECT_EQ(bench.device.node(1).state(), DriveState::switch_on_disabled);
  EXPECT_THAT(fault_of(bench.drive.read()), HasSubstr("release()"));
}

TEST(Cia402Drive, LetsDrivesStopByThemselvesWhenItsHeartbeatIsMissing) {
  Cia402Config config;
  config.host_timeout = 0.2;
  Cia402Bench bench(1, 1, config);
  ASSERT_EQ(fault_of(bench.drive.start()), "");
  ASSERT_TRUE(bench.drive.command(std::vector{4000.0}, 2));
  for (int i = 0; i < 5; ++i) {
    bench.bus.pass(0.1);
    bench.drive.keep_alive();
  }
  EXPECT_EQ(bench.device.node(0).state(), DriveState::operation_enabled);
  bench.bus.pass(0.5);
  EXPECT_EQ(bench.device.node(0).state(), DriveState::quick_stop_active);
  EXPECT_LT(bench.positions()[0], 1900);
  EXPECT_THAT(fault_of(bench.drive.read()), HasSubstr("quick stop that was not commanded"));
  bench.bus.pass(0.05);
  EXPECT_FALSE(bench.drive.read().value().moving);
}

TEST(Cia402Stop, StopsDrivesInEveryStateOfTheProgram) {
  for (const bool is_started : {true, false}) {
    Cia402Bench bench(4);
    ASSERT_TRUE(bench.drive.start());
    ASSERT_TRUE(bench.drive.command(std::vector(4, 4000.0), 2));
    bench.bus.pass(0.5);
    const StopMessages stop = cia402_stop(bench.config);
    ASSERT_LE(stop.first.size() + stop.then.size(), Guard::most_messages);
    // As if the program had died while it set the drives up.
    if (!is_started) {
      ASSERT_TRUE(bench.bus.write(bytes_of(nmt_frame(NmtCommand::pre_operational, 0))));
    }
    for (const std::string& message : stop.first) ASSERT_TRUE(bench.bus.write(message));
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(bench.device.node(i).state(), DriveState::quick_stop_active);
    bench.bus.pass(stop.delay);
    for (const std::string& message : stop.then) ASSERT_TRUE(bench.bus.write(message));
    const auto stopped = bench.positions();
    EXPECT_LT(stopped[0], 2000);
    EXPECT_THAT(fault_of(bench.drive.command(std::vector(4, 0.0), 1)),
                HasSubstr("stopped; start the drives again"));
    EXPECT_EQ(bench.positions(), stopped);
    ASSERT_EQ(fault_of(bench.drive.start()), "");
    EXPECT_EQ(fault_of(bench.drive.command(std::vector(4, 0.0), 1)), "");
  }
  Cia402Config many;
  many.axes.resize(15);
  for (std::size_t i = 0; i < 15; ++i) many.axes[i].node = static_cast<std::int64_t>(i) + 1;
  EXPECT_EQ(cia402_stop(many).first.size(), 15U);
}

}  // namespace
}  // namespace flexura
