// Rigs of one camera and of three, and cameras without heads or stages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/experiment/schedule.h"
#include "flexura/port/rig_readings.h"
#include "flexura/rig/filming.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/calibration_files.h"
#include "tests/support/experiment_files.h"
#include "tests/support/loop_files.h"
#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Returns a file with small cameras around an arm that moves for a second.
std::string around(const std::vector<std::string>& names, const std::string& task) {
  std::string text = "[arm]\nkind = \"spatial\"\n[[arm.section]]\nlength = 1\n";
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format(
        "[[camera]]\nname = \"{}\"\nmount = {{ position = [{}, 0.5, {}], look_at = [0, 0.5, 0] }}\n"
        "lens = {{ fx = 80 }}\nsensor = {{ width = 64, height = 48, frame_rate = {} }}\n",
        names[i], i == 1 ? -2 : 0, i == 1 ? 0 : (i == 0 ? 2 : -2), 10 * (i + 1));
  return text + "[[task]]\n" + task;
}

TEST(CameraCount, OneCameraIsFilmedAndReadAsWellAsThree) {
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"only"}, {"front", "side", "behind"}}) {
    const Experiment experiment = parse_experiment(
        around(names, "kind = \"move\"\nduration = 1\nto = { bends = [[0.8, 0.5]] }\n"), "x");
    const Schedule schedule(experiment);
    Filming filming(experiment);
    std::vector<int> frames(names.size(), 0);
    for (int step = 0; step <= 10; ++step)
      filming.play_to(0.1 * step, schedule.state_at(0.1 * step), [&](const FilmedFrame& filmed) {
        for (std::size_t i = 0; i < names.size(); ++i) frames[i] += filmed.camera == names[i] ? 1 : 0;
      });
    for (std::size_t i = 0; i < names.size(); ++i)
      EXPECT_NEAR(frames[i], 10 * (static_cast<int>(i) + 1), 1) << names[i];
    const RigModel model = rig_model(experiment.arm.arm(), experiment.cameras());
    const std::vector<Camera> optics(model.cameras.begin(), model.cameras.end());
    EXPECT_EQ(camera_readings(filming.ports(), optics).size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
      EXPECT_TRUE(
          std::holds_alternative<StanceReading>(read_camera(filming.ports(), i, Camera(model.cameras[i]))));
  }
}

TEST(CameraCount, ServosAndCalibrationsSayThatTheyNeedTwo) {
  const std::string target = "[[task.target]]\nbends = [[0.8, 0.3]]\n";
  for (const std::string& task : {"kind = \"servo\"\n" + target, std::string("kind = \"calibrate\"\n"),
                                  std::string("kind = \"calibrate\"\nmethod = \"etalon\"\n"),
                                  std::string("kind = \"calibrate\"\nmethod = \"arcs-paper\"\n")})
    EXPECT_THAT(error_of_file(around({"only"}, task)),
                HasSubstr("task[0]: needs two cameras: expected a second [[camera]]"))
        << task;
}

// For callers without a file.
TEST(CameraCount, AtThePortsOfOneCameraNothingIsBegun) {
  ServoBench servo(servo_file(servo_target));
  RigPorts one = servo.ports();
  one.cameras.pop_back();
  RigModel model = servo.nominal();
  const ServoConfig config = servo.config();
  ServoNotes notes;
  EXPECT_THROW((void)servo_in_session(one, model, config, notes), std::invalid_argument);
  model.cameras.pop_back();
  EXPECT_THROW((void)servo_in_session(one, model, config, notes), std::invalid_argument);
  CalibrationBench bench(small_calibration("", ""));
  NobodyWatches nobody;
  const auto& task = std::get<CalibrateTask>(bench.experiment().task.front());
  const RigSessionConfig session =
      session_config(task, bench.experiment().arm, bench.experiment().cameras(), bench.experiment().stand);
  EXPECT_THROW((void)calibrate_rig_in_session(one, model, bench.prior(), session, nobody),
               std::invalid_argument);
}

// A third camera exists beside the servo's two, and has nothing that moves it.
TEST(CameraCount, AServoByTwoOfThreeCamerasArrives) {
  const std::string third =
      "[[camera]]\nname = \"behind\"\nmount = { position = [0, 0.5, -3], look_at = [0, 0.5, 0] }\n";
  ServoBench bench(servo_file("cameras = [\"front\", \"side\"]\n" + servo_target, {.rest = third}));
  RigPorts ports = bench.ports();
  ASSERT_EQ(ports.cameras.size(), 3U);
  ports.cameras[2].head = nullptr, ports.cameras[2].stage = nullptr;
  const ServoResult result = bench.servo(ports);
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(std::get<ArmState>(bench.config().goals.back().shape)).rms, 0.006);
}

RigPorts without_heads(RigPorts ports) {
  for (CameraPorts& camera : ports.cameras) camera.head = nullptr, camera.stage = nullptr;
  return ports;
}

TEST(MissingDevices, AServoGoesTheSameWayWithoutHeadsAsWithHeadsThatStand) {
  ServoBench with(servo_file(servo_target)), without(servo_file(servo_target));
  ServoNotes one, other;
  const ServoResult first = with.servo(with.ports(), one);
  const ServoResult second = without.servo(without_heads(without.ports()), other);
  ASSERT_TRUE(first.is_done && second.is_done) << second.reason;
  EXPECT_EQ(one.sent, other.sent);
}

TEST(MissingDevices, AServoThatFollowsSaysWhichHeadIsMissingAndSendsNothing) {
  ServoBench bench(servo_file("follow = true\n" + servo_target));
  RigPorts ports = bench.ports();
  ports.cameras[1].head = nullptr;
  ServoNotes notes;
  const ServoResult result = bench.servo(ports, notes);
  EXPECT_FALSE(result.is_done);
  EXPECT_EQ(result.reason,
            "camera side has no head: it cannot pan, tilt or zoom, and the servo needs both heads to follow "
            "the arm");
  EXPECT_TRUE(notes.sent.empty());
  EXPECT_FALSE(bench.ports().cameras[0].head->read().value().moving);
}

class CountsWhatIsSent : public NobodyWatches {
 public:
  int sent = 0;
  void arm_sent(double, const ArmState&, double) override { ++sent; }
  void camera_sent(double, const RigStance&) override { ++sent; }
};

TEST(MissingDevices, ACalibrationSaysWhatIsMissingBeforeAnythingMoves) {
  for (const char* method : {"etalon", "etalon-paper"}) {
    CalibrationBench bench(etalon_rig(fmt::format("method = \"{}\"\n", method), {.size = 0.25}));
    RigPorts ports = bench.ports();
    ports.cameras[1].head = nullptr;
    CountsWhatIsSent watcher;
    LoopResult result = bench.calibrate(ports, watcher);
    EXPECT_FALSE(result.is_done);
    EXPECT_EQ(result.reason,
              "cannot calibrate: camera side has no head: it cannot pan, tilt or zoom; nothing "
              "was moved");
    ports = bench.ports();
    ports.cameras[0].stage = nullptr;
    result = bench.calibrate(ports, watcher);
    EXPECT_EQ(result.reason,
              "cannot calibrate: camera front has no stage: it cannot be translated, but its mount.stage has "
              "travel; nothing was moved");
    EXPECT_EQ(watcher.sent, 0);
    bench.expect_back();
  }
  CalibrationBench bench(small_calibration("", ""));
  RigPorts ports = bench.ports();
  ports.cameras[0].head = nullptr;
  CountsWhatIsSent watcher;
  EXPECT_THAT(bench.calibrate_bundle(ports, watcher).reason, HasSubstr("camera front has no head"));
  EXPECT_EQ(watcher.sent, 0);
}

}  // namespace
}  // namespace flexura
