#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "flexura/base/problems.h"
#include "flexura/equipment/gstreamer_camera.h"
#include "flexura/equipment/onvif_server.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/port/driven_arm.h"
#include "tests/support/laboratory.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

std::string problems_of(const std::string& text) {
  try {
    (void)parse_experiment(text, "lab.toml");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

// All waits are long: a busy machine must not fail a test.
Experiment patient(Experiment experiment) {
  constexpr double patience = 30;  // s
  RigEquipment& rig = experiment.equipment.value();
  rig.watchdog = patience;
  for (GrblConfig& grbl : rig.grbl) grbl.answer_timeout = 10, grbl.connect_timeout = patience;
  for (CameraEquipment& camera : rig.camera)
    if (camera.gstreamer) camera.gstreamer->silence = patience;
  return experiment;
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
  // A serial line is the same at any speed, and belongs to one device.
  EXPECT_THAT(problems_of(good + "visca.bus.link = \"/dev/ttyUSB0@9600\"\n"),
              HasSubstr("\"/dev/ttyUSB0@9600\" is used by rig.grbl[0].link: expected another device"));
  std::string homed = good;
  homed.replace(homed.find("watchdog = 0.2"), 14, "start = \"homed\"");
  EXPECT_THAT(problems_of(homed), HasSubstr("0 positions: expected 3, one per axis"));
  homed.replace(homed.find("homed"), 5, "pretensioned");
  EXPECT_THAT(problems_of(homed), HasSubstr("0 positions: expected 3, one per axis"));
  std::string kinematic = good;
  kinematic.erase(kinematic.find("[drive]"), kinematic.find("[[camera]]") - kinematic.find("[drive]"));
  EXPECT_THAT(problems_of(kinematic), HasSubstr("the arm has no drive to run"));
}

TEST(Equipment, AnOnvifHeadOfAFileIsChecked) {
  const std::string good = lab_file("/dev/ttyUSB0", 1, "onvif.link = \"tcp:camera:80\"\n");
  EXPECT_EQ(problems_of(good), "");
  EXPECT_THAT(problems_of(lab_file("/dev/ttyUSB0", 1, "onvif.link = \"udp:camera:80\"\n")),
              HasSubstr("expected tcp:HOST:PORT"));
  EXPECT_THAT(problems_of(good + "onvif.user = \"operator\"\n"),
              HasSubstr("expected user and password_file"));
  EXPECT_THAT(problems_of(good + "onvif.pan.limits = [1, -1]\n"), HasSubstr("the smaller position first"));
  EXPECT_THAT(problems_of(good + "visca.bus.link = \"udp:camera:1259\"\n"),
              HasSubstr("2 heads: expected one"));
}

TEST(Equipment, RunsWithAnOnvifHead) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  Controller controller;
  OnvifDevice camera;
  camera.model().most_age = 300;
  OnvifServer server(camera);
  const TemporaryFolder folder;
  const std::string password = folder.path() / "password";
  std::ofstream(password) << "secret\n";
  const std::string head = fmt::format(
      "onvif.link = \"tcp:127.0.0.1:{}\"\nonvif.user = \"operator\"\nonvif.password_file = \"{}\"\n"
      "onvif.reply_timeout = 30\n",
      server.port(), password);
  const Experiment experiment = patient(parse_experiment(lab_file(controller.path, 0.5, head), "lab.toml"));
  NoProgress nobody;
  const RunResult result = run_experiment(experiment, make_new_folder(folder.path() / "results"), nobody);
  EXPECT_EQ(result.outcome, RunOutcome::done) << ::testing::PrintToString(result.reasons);
  const auto lock = server.lock();
  EXPECT_GE(camera.executed("GetStatus"), 1U);
  EXPECT_GE(camera.executed("Stop"), 1U) << "at the end";
}

TEST(Equipment, MovesAsTheTaskSays) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  Controller controller;
  const Experiment experiment = patient(parse_experiment(lab_file(controller.path, 0.5, ""), "lab.toml"));
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

}  // namespace
}  // namespace flexura
