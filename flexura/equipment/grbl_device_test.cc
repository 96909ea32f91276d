#include "flexura/equipment/grbl_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace flexura {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A terminal at a controller.
class Terminal {
 public:
  explicit Terminal(GrblDeviceConfig config = {}) : device(std::move(config)) { (void)wait(0.01); }
  // Sends bytes, waits, and returns all that the controller says.
  std::string send(const std::string& bytes, double duration = 0.01) {
    std::string heard;
    for (const std::string& one : device.receive(bytes, now)) heard += one;
    return heard + wait(duration);
  }
  std::string wait(double duration) {
    std::string heard;
    for (const double end = now + duration; now < end;) {
      now = std::min(end, now + 0.005);
      for (const std::string& one : device.advance(now)) heard += one;
    }
    return heard;
  }
  GrblDevice device;
  double now = 0;
};

// Time at which a motor reaches a position, after `from`.
double arrival(Terminal& terminal, double position, double within) {
  const double start = terminal.now;
  while (terminal.now < start + within) {
    (void)terminal.wait(0.005);
    if (terminal.device.positions(terminal.now)[0] == position) return terminal.now - start;
  }
  return -1;
}

TEST(GrblDevice, GreetsAndAnswers) {
  Terminal terminal;
  EXPECT_THAT(terminal.send("\x18"), HasSubstr("Grbl 1.1h ['$' for help]\r\n"));
  EXPECT_EQ(terminal.send("\n"), "ok\r\n");
  EXPECT_THAT(terminal.send("$$\n"), HasSubstr("$100=100.000\r\n"));
  EXPECT_THAT(terminal.send("$I\n"), HasSubstr("[OPT:V,15,128]\r\nok\r\n"));
  EXPECT_THAT(terminal.send("$G\n"), HasSubstr("[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]\r\nok\r\n"));
  EXPECT_THAT(terminal.send("?"),
              HasSubstr("<Idle|MPos:0.000,0.000,0.000|Bf:15,128|FS:0,0|WCO:0.000,0.000,0.000>"));
  EXPECT_THAT(GrblDevice({.axes = 6, .is_grblhal = true}).advance(1),
              testing::Contains(HasSubstr("GrblHAL")));
  EXPECT_THROW(GrblDevice({.axes = 9}), std::invalid_argument);
}

TEST(GrblDevice, RefusesBadLines) {
  Terminal terminal;
  EXPECT_EQ(terminal.send("$Q\n"), "error:3\r\n");
  EXPECT_EQ(terminal.send("G1X1\n"), "error:22\r\n");
  EXPECT_EQ(terminal.send("X\n"), "error:2\r\n");
  EXPECT_EQ(terminal.send("1\n"), "error:1\r\n");
  EXPECT_EQ(terminal.send("G2X1I1F100\n"), "error:20\r\n");
  EXPECT_EQ(terminal.send("G0G1X1\n"), "error:21\r\n");
  EXPECT_EQ(terminal.send("G1X1X2F1\n"), "error:25\r\n");
  EXPECT_EQ(terminal.send("$J=X1\n"), "error:22\r\n");
  EXPECT_EQ(terminal.send("$J=M3X1F1\n"), "error:16\r\n");
  EXPECT_EQ(terminal.send("$H\n"), "error:5\r\n");
  EXPECT_EQ(terminal.send("$20=1\n"), "error:10\r\n");
  EXPECT_EQ(terminal.send("$100=-1\n"), "error:4\r\n");
  EXPECT_EQ(terminal.send("$J=" + std::string(100, ' ') + "\n"), "error:11\r\n");
}

TEST(GrblDevice, MovesWithLimitedRateAndAcceleration) {
  Terminal terminal;
  // 50 mm at 100 mm/s with 1000 mm/s^2: 0.5 s and 0.1 s of acceleration.
  EXPECT_EQ(terminal.send("$J=G90X50F100000\n", 0), "ok\r\n");
  EXPECT_EQ(terminal.device.state(), GrblState::jog);
  EXPECT_NEAR(arrival(terminal, 5000, 2), 0.6, 0.02);
  (void)terminal.wait(0.05);
  EXPECT_EQ(terminal.device.state(), GrblState::idle);
  // 0.4 mm does not reach the rate: 2 sqrt(0.4 / 1000) = 0.04 s.
  (void)terminal.send("$J=G91X0.4F6000\n", 0);
  EXPECT_NEAR(arrival(terminal, 5040, 2), 0.04, 0.012);
}

TEST(GrblDevice, DoesNotStopBetweenBlocksInLine) {
  Terminal terminal;
  std::string lines;
  for (int i = 1; i <= 5; ++i) lines += "G1X" + std::to_string(10 * i) + "F3000\n";
  EXPECT_EQ(terminal.send(lines, 0), "ok\r\nok\r\nok\r\nok\r\nok\r\n");
  EXPECT_EQ(terminal.device.state(), GrblState::run);
  EXPECT_NEAR(arrival(terminal, 5000, 3), 50 / 50.0 + 0.05, 0.03);
  // It stops before it turns back.
  (void)terminal.send("G1X40\nG1X50\n", 0);
  EXPECT_NEAR(arrival(terminal, 4000, 3), 10 / 50.0 + 0.05, 0.03);
}

TEST(GrblDevice, AnswersALineWhenItsQueueHasRoomAndLosesBytesThatDoNotFit) {
  Terminal terminal;
  std::string lines;
  for (int i = 1; i <= 17; ++i) lines += "G1X" + std::to_string(i % 2) + "F60\n";
  std::string heard = terminal.send(lines, 0);
  EXPECT_EQ(std::ranges::count(heard, '\n'), 15);
  EXPECT_EQ(terminal.device.lost_bytes(), 0U);
  heard = terminal.wait(5);
  EXPECT_EQ(std::ranges::count(heard, '\n'), 2);
  (void)terminal.send(lines + lines, 0);
  EXPECT_GT(terminal.device.lost_bytes(), 0U);
}

TEST(GrblDevice, CancelsJogs) {
  Terminal terminal;
  (void)terminal.send("$J=G90X50F6000\n$J=G90X100F6000\n", 0.3);
  const double before = terminal.device.positions(terminal.now)[0];
  (void)terminal.send("\x85", 0.3);
  EXPECT_EQ(terminal.device.state(), GrblState::idle);
  // Braking from 100 mm/s begins after 0.06 s and takes 5 mm.
  EXPECT_NEAR(terminal.device.positions(terminal.now)[0] - before, 1100, 40);
  EXPECT_EQ(terminal.send("G0X0\n"), "ok\r\n");
}

TEST(GrblDevice, HoldsAndResumes) {
  Terminal terminal;
  (void)terminal.send("G1X50F6000\n", 0.3);
  EXPECT_THAT(terminal.send("!?", 0), HasSubstr("<Hold:1|"));
  EXPECT_EQ(terminal.send("$G\n", 0.2), "");
  EXPECT_THAT(terminal.send("?"), HasSubstr("<Hold:0|"));
  const double held = terminal.device.positions(terminal.now)[0];
  EXPECT_LT(held, 5000);
  EXPECT_THAT(terminal.send("~", 1), HasSubstr("[GC:"));
  EXPECT_EQ(terminal.device.positions(terminal.now)[0], 5000);
}

TEST(GrblDevice, LosesStepsWhenResetInMotion) {
  Terminal terminal;
  (void)terminal.send("$J=G90X50F6000\n", 0.3);
  const std::string heard = terminal.send("\x18?");
  EXPECT_THAT(heard, HasSubstr("ALARM:3\r\n"));
  EXPECT_THAT(heard, HasSubstr("[MSG:'$H'|'$X' to unlock]"));
  const auto at = heard.find("MPos:") + 5;
  const double counted = 100 * std::stod(heard.substr(at));
  EXPECT_NEAR(terminal.device.positions(terminal.now)[0] - counted, 100 * 100 * 0.002, 1);
  EXPECT_EQ(terminal.send("G0X0\n"), "error:9\r\n");
  EXPECT_EQ(terminal.send("$J=X1F1\n"), "error:8\r\n");
  EXPECT_EQ(terminal.send("$X\n"), "[MSG:Caution: Unlocked]\r\nok\r\n");
  // At rest, a reset keeps the position.
  EXPECT_THAT(terminal.send("\x18"), testing::Not(HasSubstr("ALARM")));
}

TEST(GrblDevice, KeepsSoftLimits) {
  Terminal terminal({.settings = {{20, 1}, {22, 1}}});
  EXPECT_EQ(terminal.device.state(), GrblState::alarm);
  (void)terminal.send("$X\n");
  EXPECT_EQ(terminal.send("$J=G53X1F100\n"), "error:15\r\n");
  EXPECT_EQ(terminal.send("$J=G53X-1F6000\n", 0.2), "ok\r\n");
  EXPECT_THAT(terminal.send("G0X5\n"), HasSubstr("ALARM:2\r\n[MSG:Reset to continue]"));
  EXPECT_EQ(terminal.send("$X\n?"), "");
  EXPECT_THAT(terminal.send("\x18"), HasSubstr("Grbl"));
}

TEST(GrblDevice, HomesAtItsSwitches) {
  GrblDeviceConfig config{.settings = {{22, 1}, {23, 2}, {24, 300}, {25, 3000}}};
  config.low = {-9000, -4000, -9000};
  config.high = {3000, 9000, 5000};
  Terminal terminal(config);
  EXPECT_EQ(terminal.send("$H\n?", 0.1), "");
  EXPECT_THAT(terminal.wait(10), HasSubstr("ok\r\n"));
  EXPECT_THAT(terminal.send("?"), HasSubstr("<Idle|MPos:-1.000,-199.000,-1.000"));
  const std::vector<double> motors = terminal.device.positions(terminal.now);
  EXPECT_NEAR(motors[0], 2900, 5);
  EXPECT_NEAR(motors[1], -3900, 5);
  EXPECT_NEAR(motors[2], 4900, 5);
  (void)terminal.send("$H\n", 0.1);
  EXPECT_THAT(terminal.send("\x18"), HasSubstr("ALARM:6"));
}

TEST(GrblDevice, FindsNoSwitchThatIsNotThere) {
  Terminal terminal({.settings = {{22, 1}, {25, 6000}}});
  EXPECT_THAT(terminal.send("$H\n", 5), HasSubstr("ALARM:9"));
}

TEST(GrblDevice, StopsAtHardLimits) {
  GrblDeviceConfig config{.settings = {{21, 1}}};
  config.low = {-9000, -9000, -9000};
  config.high = {1000, 9000, 9000};
  Terminal terminal(config);
  EXPECT_THAT(terminal.send("$J=G90X50F6000\n", 1), HasSubstr("ALARM:1\r\n[MSG:Reset to continue]"));
  EXPECT_NEAR(terminal.device.positions(terminal.now)[0], 1000, 60);
}

TEST(GrblDevice, HasWorkCoordinates) {
  Terminal terminal({.settings = {{10, 0}}});
  EXPECT_EQ(terminal.send("G10L20P1X5\n"), "ok\r\n");
  EXPECT_THAT(terminal.send("?"), HasSubstr("WPos:5.000,0.000,0.000"));
  EXPECT_EQ(terminal.send("G0X6\n", 1), "ok\r\n");
  EXPECT_EQ(terminal.device.positions(terminal.now)[0], 100);
  EXPECT_EQ(terminal.send("G92X0\nG91G20G1X1F100\n", 2), "ok\r\nok\r\n");
  EXPECT_EQ(terminal.device.positions(terminal.now)[0], 2640);
}

}  // namespace
}  // namespace flexura
