// A program that runs equipment and is killed.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <thread>
#include <vector>

#include "flexura/equipment/gstreamer_camera.h"
#include "tests/support/laboratory.h"
#include "tests/support/program.h"

namespace flexura {
namespace {

using EquipmentProgram = Program;

TEST_F(EquipmentProgram, LeavesAnArmThatStandsWhenItIsKilled) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  // The limits only end a test that hangs: sanitizers on a busy machine are slow.
  constexpr double patience = 120;  // s
  Controller controller;
  std::ofstream(path("lab.toml")) << lab_file(controller.path, 60);
  const pid_t program = start("run lab.toml --out results", path("out"));
  const auto nap = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  const std::vector<double> at_start = {0, 0, 0};
  const double began = DeviceServer::now();
  while (controller.positions() == at_start && DeviceServer::now() < began + patience) nap();
  EXPECT_NE(controller.positions(), at_start) << "the arm does not move";
  kill(program, SIGKILL);
  (void)wait(program);
  // Braking takes some time. Then nothing moves any more.
  const double killed = DeviceServer::now();
  std::vector<double> last = controller.positions();
  double stands_since = killed;
  while (DeviceServer::now() < stands_since + 0.5 && DeviceServer::now() < killed + patience) {
    nap();
    if (controller.positions() != last) last = controller.positions(), stands_since = DeviceServer::now();
  }
  EXPECT_LT(DeviceServer::now(), killed + patience) << "the arm still moves";
  EXPECT_EQ(controller.positions(), last);
}

}  // namespace
}  // namespace flexura
