#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "flexura/base/problems.h"
#include "flexura/equipment/device_server.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/gstreamer_camera.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/port/driven_arm.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// An arm of one section with three tendons, a camera that shows a test picture, and a move of `duration` s.
std::string lab_file(const std::string& link, double duration, const std::string& rest = "") {
  return fmt::format(R"(
[arm]
kind = "spatial"
[[arm.section]]
length = 0.3
[drive]
radius = 0.01
[[drive.tendon]]
section = 1
angle_deg = 0
[[drive.tendon]]
section = 1
angle_deg = 120
[[drive.tendon]]
section = 1
angle_deg = 240
[[camera]]
name = "front"
lens.fx = 400
sensor.width = 160
sensor.height = 120
mount.position = [0, 0.1, 1]
mount.look_at = [0, 0, 0.1]
[record]
report = false
[[task]]
kind = "move"
duration = {1}
to.bends = [[0.3, 0.2]]
[rig]
watchdog = 0.2
[[rig.grbl]]
link = "{0}"
[[rig.camera]]
name = "front"
gstreamer.source = "videotestsrc is-live=true ! video/x-raw,width=160,height=120"
{2}
)",
                     link, duration, rest);
}

std::string problems_of(const std::string& text) {
  try {
    (void)parse_experiment(text, "lab.toml");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Equipment, OfAFileMustFitItsRig) {
  const std::string good = lab_file("/dev/ttyUSB0", 1);
  EXPECT_EQ(problems_of(good), "");
  EXPECT_THAT(problems_of(good + "[[rig.grbl]]\nlink = \"/dev/ttyUSB1\"\n"),
              HasSubstr("6 axes of controllers: expected 3, one per tendon of the drive"));
  EXPECT_THAT(problems_of(good + "[[rig.camera]]\nname = \"side\"\nv4l2.device = \"/dev/video0\"\n"),
              HasSubstr("\"side\" is no camera of the experiment: expected front"));
  EXPECT_THAT(problems_of(good + "v4l2.device = \"/dev/video0\"\n"), HasSubstr("2 sources of pictures"));
  EXPECT_THAT(problems_of(good + "[[rig.camera]]\nname = \"front\"\nv4l2.device = \"/dev/video0\"\n"),
              HasSubstr("\"front\" has devices already"));
  std::string homed = good;
  homed.replace(homed.find("watchdog = 0.2"), 14, "start = \"homed\"");
  EXPECT_THAT(problems_of(homed), HasSubstr("0 positions: expected 3, one per axis"));
  std::string kinematic = good;
  kinematic.erase(kinematic.find("[drive]"), kinematic.find("[[camera]]") - kinematic.find("[drive]"));
  EXPECT_THAT(problems_of(kinematic), HasSubstr("the arm has no drive to run"));
}

// A simulated controller on a serial line.
struct Controller {
  Controller() : Controller(open_serial_pair()) {}
  explicit Controller(SerialPair pair)
      : path(pair.path), kept(std::move(pair.kept)), server(std::move(pair.device), device) {}
  std::vector<double> positions() {
    const auto lock = server.lock();
    return device.positions(DeviceServer::now());
  }
  GrblDevice device{GrblDeviceConfig{
      .settings = {{100, 100}, {101, 100}, {102, 100}, {110, 6000}, {111, 6000}, {112, 6000}}}};
  std::string path;
  Descriptor kept;
  DeviceServer server;
};

TEST(Equipment, MovesAsTheTaskSays) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  Controller controller;
  const Experiment experiment = parse_experiment(lab_file(controller.path, 0.5, ""), "lab.toml");
  const TemporaryFolder folder;
  NoProgress nobody;
  const RunResult result = run_experiment(experiment, make_new_folder(folder.path() / "results"), nobody);
  EXPECT_EQ(result.outcome, RunOutcome::done) << ::testing::PrintToString(result.reasons);
  const ArmModel arm = experiment.arm_model();
  ArmState end = ArmState::straight(1);
  end.bends[0] = {0.3, 0.2};
  const std::vector<std::int64_t> expected =
      nominal_positions(experiment.arm.arm(), experiment.drive->drive(), end);
  const std::vector<double> found = controller.positions();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], static_cast<double>(expected[i]), 1.0) << i;
}

TEST(Equipment, StopsWhenTheProgramIsKilled) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  Controller controller;
  const TemporaryFolder folder;
  const pid_t program = ::fork();
  if (program == 0) {
    NoProgress nobody;
    try {
      (void)run_experiment(parse_experiment(lab_file(controller.path, 60), "lab.toml"),
                           make_new_folder(folder.path() / "results"), nobody);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    ::_exit(1);
  }
  const auto nap = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  const double start = DeviceServer::now();
  while (controller.positions() == std::vector<double>{0, 0, 0} && DeviceServer::now() < start + 30) nap();
  EXPECT_NE(controller.positions(), (std::vector<double>{0, 0, 0})) << "the arm has not started to move";
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  // Braking takes some time. Then nothing moves any more.
  const double killed = DeviceServer::now();
  std::vector<double> last = controller.positions();
  double stood_since = killed;
  while (DeviceServer::now() < stood_since + 0.5 && DeviceServer::now() < killed + 60) {
    nap();
    if (controller.positions() != last) last = controller.positions(), stood_since = DeviceServer::now();
  }
  EXPECT_LT(DeviceServer::now(), killed + 60) << "the arm still moves";
  EXPECT_LT(std::abs(last[0]), 1000);
}

}  // namespace
}  // namespace flexura
