// A program that runs equipment and is killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "flexura/equipment/gstreamer_camera.h"
#include "tests/support/laboratory.h"
#include "tests/support/program.h"

namespace flexura {
namespace {

// The limits only end a test that hangs: sanitizers on a busy machine are slow.
constexpr double patience = 120;  // s

class EquipmentProgram : public Program {
 protected:
  // Starts a run and waits until the arm moves.
  pid_t moving(const std::string& file, Controller& controller) {
    std::ofstream(path("lab.toml")) << file;
    std::filesystem::remove_all(path("results"));
    const std::vector<double> at_start = controller.positions();
    const pid_t program = start("run lab.toml --out results", path("out"));
    const double began = DeviceServer::now();
    while (controller.positions() == at_start && DeviceServer::now() < began + patience) nap();
    EXPECT_NE(controller.positions(), at_start) << "the arm does not move";
    return program;
  }
  // Waits until the arm stands. Braking takes some time.
  static void expect_rest(Controller& controller) {
    const double since = DeviceServer::now();
    std::vector<double> last = controller.positions();
    double stands_since = since;
    while (DeviceServer::now() < stands_since + 0.5 && DeviceServer::now() < since + patience) {
      nap();
      if (controller.positions() != last) last = controller.positions(), stands_since = DeviceServer::now();
    }
    EXPECT_LT(DeviceServer::now(), since + patience) << "the arm still moves";
  }
  static GrblState state_of(Controller& controller) {
    const auto lock = controller.server.lock();
    return controller.device.state();
  }
  static void nap() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }
};

// The motors home for hours, unless something stops them.
GrblDeviceConfig homing_for_hours() {
  GrblDeviceConfig config;
  config.settings = {{100, 100}, {101, 100}, {102, 100}, {110, 6000}, {111, 6000}, {112, 6000}, {20, 0},
                     {21, 1},    {22, 1},    {25, 100},  {130, 1e5},  {131, 1e5},  {132, 1e5}};
  config.low = std::vector<double>(3, -1e7), config.high = std::vector<double>(3, 1e7);
  return config;
}

std::string homed(std::string file) {
  const std::string place = "watchdog = 0.2\n";
  return file.insert(file.find(place) + place.size(), "start = \"homed\"\nhome = [0, 0, 0]\n");
}

// A machine that is slower than the watchdog's period is stopped by the guard before the signal comes.
bool was_too_slow(const Ended& ended) {
  return ended.status == 3 && ended.err.find("the watchdog stopped all devices") != std::string::npos;
}

TEST_F(EquipmentProgram, LeavesAnArmThatStandsWhenItIsKilled) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  Controller controller;
  const pid_t program = moving(lab_file(controller.path, 60), controller);
  kill(program, SIGKILL);
  (void)wait(program);
  expect_rest(controller);
}

TEST_F(EquipmentProgram, HaltsTheArmWhenItIsStopped) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  for (const int signal : {SIGINT, SIGTERM}) {
    Controller controller;
    const pid_t program = moving(lab_file(controller.path, 60), controller);
    kill(program, signal);
    const Ended ended = wait(program);
    expect_rest(controller);
    if (was_too_slow(ended)) continue;
    EXPECT_EQ(ended.status, 128 + signal) << ended.err;
    EXPECT_THAT(ended.err, ::testing::HasSubstr("cancelled: "));
  }
}

TEST_F(EquipmentProgram, IsStoppedByItsGuardWhenItHangs) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  Controller controller;
  const pid_t program = moving(lab_file(controller.path, 60), controller);
  kill(program, SIGSTOP);
  expect_rest(controller);
  kill(program, SIGCONT);
  const Ended ended = wait(program);
  EXPECT_EQ(ended.status, 3);
  EXPECT_THAT(ended.err, ::testing::HasSubstr("the watchdog stopped all devices"));
  expect_rest(controller);
}

TEST_F(EquipmentProgram, StopsMotorsThatHome) {
  for (const int signal : {SIGKILL, SIGINT, SIGTERM, SIGSTOP}) {
    SCOPED_TRACE(signal);
    Controller controller{homing_for_hours()};
    const pid_t program = moving(homed(lab_file(controller.path, 60)), controller);
    EXPECT_THAT(state_of(controller), ::testing::AnyOf(GrblState::home, GrblState::alarm));
    kill(program, signal);
    if (signal == SIGSTOP) {
      expect_rest(controller);
      kill(program, SIGCONT);
    }
    const Ended ended = wait(program);
    expect_rest(controller);
    EXPECT_EQ(state_of(controller), GrblState::alarm) << "only a reset stops homing";
    if ((signal == SIGINT || signal == SIGTERM) && !was_too_slow(ended)) {
      EXPECT_EQ(ended.status, 128 + signal);
      EXPECT_EQ(ended.err, "cancelled: stopped while the motors went to their first positions\n");
    }
    if (signal == SIGSTOP) {
      EXPECT_EQ(ended.status, 3);
      EXPECT_THAT(ended.err, ::testing::HasSubstr("the watchdog stopped all devices"));
    }
  }
}

}  // namespace
}  // namespace flexura
