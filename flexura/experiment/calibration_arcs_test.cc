#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/calibrate/arcs_loop.h"
#include "flexura/math/arrays.h"
#include "flexura/picture/image_file.h"
#include "flexura/tasks/calibrate/calibrate_config.h"
#include "flexura/tasks/calibrate/calibration_messages.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/experiment_files.h"
#include "tests/support/loop_files.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Tendons at three angles around each section, each on its own spool.
const char* const tendon_drive =
    "[drive]\nradius_mm = 14\ntendon = [\n"
    "{ section = 1, angle_deg = 0 }, { section = 1, angle_deg = 120 }, { section = 1, angle_deg = 240 },\n"
    "{ section = 2, angle_deg = 40 }, { section = 2, angle_deg = 160 }, { section = 2, angle_deg = 280 },\n"
    "{ section = 3, angle_deg = 80 }, { section = 3, angle_deg = 200 }, { section = 3, angle_deg = 320 }]\n"
    "[drive.motor]\nphases = 3\nsteps = 600\nmicrosteps = 10\nmax_speed_deg = 3600\n"
    "max_acceleration = 3000\nmax_step_rate = 100e3\n"
    "[drive.spool]\nradius_mm = 10\ngear = 10\nbacklash_deg = 0.1\n";

TEST(ArcsCalibration, LogsAndReportsItsArcsDriveCommandsAndIdealImages) {
  const LoopRig rig =
      arcs_cameras({WrongStart{.pan = 0.03, .tilt = 0.02}, WrongStart{.shift = {0, 0, 0.05}}}, true);
  Runs runs;
  const RunResult result = runs.run(tendon_drive + arcs_rig("method = \"arcs-paper\"\n", rig));
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const auto arcs = logged<CalibrationArcMessage>(result, calibration_arcs_topic);
  const auto commands = logged<DriveCommandsMessage>(result, drive_commands_topic);
  const auto last = logged<CalibrationDecisionMessage>(result, calibration_decisions_topic).back();
  std::map<std::string, CalibrationObservationMessage> first;  // By camera.
  for (const auto& observation :
       logged<CalibrationObservationMessage>(result, calibration_observations_topic))
    first.emplace(observation.camera, observation);
  ASSERT_EQ(arcs.size(), 2U);
  EXPECT_EQ(arcs[0].camera + " " + arcs[0].plane, "front XOY");
  EXPECT_EQ(arcs[1].camera + " " + arcs[1].plane, "side ZOY");
  for (const CalibrationArcMessage& arc : arcs) {
    const CalibrationObservationMessage& observation = first.at(arc.camera);
    double bend = 0;
    for (std::size_t i = 0; i < arc.bends.size(); ++i) {
      bend += std::hypot(arc.bends[i][0], arc.bends[i][1]);
      EXPECT_NEAR(std::atan2(arc.bends[i][1], arc.bends[i][0]), arc.rotations.at(i), 1e-12);
    }
    EXPECT_NEAR(bend, 2 * std::numbers::pi / 3, 1e-9);
    // The motors' actual commands when the camera took the picture.
    const auto after = std::ranges::upper_bound(commands, observation.time, {}, &DriveCommandsMessage::time);
    EXPECT_EQ(arc.positions, std::prev(after)->positions) << arc.camera;
    // The ideal axis is along the ideal picture's arm, and a circle is fitted in the real picture.
    const Picture ideal =
        read_png(logged<ImageMessage>(result, ideal_image_topic(arc.camera)).front().data.data);
    const auto& picture = std::get<Image<std::uint8_t>>(ideal);
    ASSERT_TRUE(observation.ideal && observation.circle);
    const auto& [u, v] = (*observation.ideal)[observation.ideal->size() / 2];
    EXPECT_LT(picture.at(static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v))) + 50,
              picture.at(2, 2));
    EXPECT_NEAR(arc.focal / 2.5 / (2 * std::numbers::pi / 3), observation.circle->radius, 20);
  }
  EXPECT_TRUE(last.ended.value_or(false));
  EXPECT_EQ(last.next, "calibrated");
  const std::string report = text_of(result, report_file_name);
  for (const char* part :
       {"The arc in the plane XOY, for camera front: sections bend by 42.00, 42.00, 36.00 deg, "
        "in directions rotated by 0.00, 0.00, 0.00 deg",
        "; motors at ", "camera side, ideal picture of the arc in the plane ZOY"})
    EXPECT_THAT(report, HasSubstr(part));
}

TEST(EtalonLoop, RefusesKeysThatCountForNothing) {
  const auto problems_of = [](const std::string& text) {
    std::vector<std::string> problems;
    try {
      (void)parse_experiment(text, "x.toml");
    } catch (const InputError& error) {
      for (const auto& problem : error.problems()) problems.push_back(problem.what);
    }
    return problems;
  };
  const LoopRig rig = {.size = 0.5};
  EXPECT_THAT(
      problems_of(etalon_rig("method = \"etalon\"\nzooms = [1, 2]\n"
                             "loop = { turn_deg = 1, slide = 0.1, zoom_step = 0.1, arc_deg = 100 }\n",
                             rig)),
      ::testing::ElementsAre(
          "task[0].loop.turn: this key applies only to the method etalon-paper: expected no such key",
          "task[0].loop.slide: this key applies only to the method etalon-paper: expected no such key",
          "task[0].loop.zoom_step: this key applies only to the method etalon-paper: expected no such key",
          "task[0].loop.arc: this key applies only to the methods arcs and arcs-paper: expected no such key",
          "task[0].zooms: this key applies only to the method bundle: expected no such key"));
  const LoopRig arcs = arcs_cameras({WrongStart{}, WrongStart{}});
  const std::string count =
      ": this key applies only to the methods bundle and bundle-etalon: expected no such key";
  EXPECT_THAT(
      problems_of(arcs_rig(
          "method = \"arcs\"\ncamera_prior = { focal_std = 0.2, principal_point_std = 3, zero_std = 0.1, "
          "rotation_std = 0.1, exact_heads = true }\nloop.arc_deg = 80\n",
          arcs)),
      ::testing::ElementsAre("task[0].camera_prior.focal_std" + count,
                             "task[0].camera_prior.principal_point_std" + count,
                             "task[0].camera_prior.zero_std" + count));
  EXPECT_THAT(problems_of(etalon_rig("method = \"etalon-paper\"\nloop = { turn_deg = 1, slide = 0.1, "
                                     "zoom_step = 0.1, accepted = 1, zoom_accepted = 0.1 }\n",
                                     rig)),
              ::testing::IsEmpty());
}

TEST(ArcsLoop, TakesTheRigForAsWrongAsTheFileSays) {
  CalibrationBench bench(
      arcs_rig("method = \"arcs\"\ncamera_prior = { rotation_std = 0.02, exact_heads = true }\n",
               arcs_cameras({WrongStart{}, WrongStart{}}, false)));
  const Experiment& file = bench.experiment();
  const LoopConfig config =
      loop_config(std::get<CalibrateTask>(file.task.front()), file.arm, file.cameras(), file.stand);
  ASSERT_TRUE(config.prior.has_value());
  const RigPrior prior = arcs_prior(*config.prior);
  for (const CameraPrior& camera : prior.cameras) {
    EXPECT_EQ(camera.rotation, 0.02);
    EXPECT_EQ(camera.steps, 0);
    EXPECT_EQ(camera.pan_zero, 0);
    EXPECT_EQ(camera.tilt_zero, 0);
    EXPECT_EQ(camera.principal_point, 1);
    EXPECT_EQ(camera.focal, 0);
  }
}

// Relative to the distance from the target: the cylinder may be far from the arm's base.
TEST(EtalonLoop, DoubtsPlacesByTheDistanceFromTheCylinder) {
  const CalibrationBench bench(
      etalon_rig("method = \"bundle-etalon\"\ncamera_prior.position_std = 0.1\n", {}, "height = 0.4\n"));
  const Experiment& file = bench.experiment();
  const RigModel nominal = rig_model(file.arm.arm(), file.cameras());
  const RigPrior prior = session_prior(std::get<CalibrateTask>(file.task.front()), nominal, file.stand);
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Vector3d from = vector(nominal.cameras[i].mount.position);
    EXPECT_NEAR(prior.cameras[i].position, 0.1 * (from - Eigen::Vector3d(0, 0.3 + 0.5 * 0.4, 0)).norm(),
                1e-12);
  }
}

}  // namespace
}  // namespace flexura
