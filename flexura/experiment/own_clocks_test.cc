// Tasks with devices that have their own clocks, a thousand seconds apart and with drift.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/calibration_bench.h"
#include "tests/support/calibration_files.h"
#include "tests/support/own_clock.h"
#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

constexpr double clocks_ahead = 1000, clocks_drift = 5e-5;

std::vector<SensorConfig> sensors_of(const Experiment& experiment) {
  std::vector<SensorConfig> sensors;
  for (const CameraConfig& camera : experiment.cameras()) sensors.push_back(camera.sensor);
  return sensors;
}

TEST(OwnClocks, AServoGoesAsByTheRigsClock) {
  ServoBench plain(servo_file(servo_target)), bench(servo_file(servo_target));
  OwnClocks clocks(bench.ports(), clocks_ahead, clocks_drift);
  const ServoResult desired = plain.servo(),
                    result = bench.servo(clocks.mapped(sensors_of(bench.experiment())));
  ASSERT_TRUE(result.is_done) << result.reason;
  const ArmState target = std::get<ArmState>(bench.config().goals.back().shape);
  EXPECT_LT(bench.truth(target).rms, 0.006);
  EXPECT_NEAR(bench.truth(target).rms, plain.truth(target).rms, 5e-4);
  EXPECT_NEAR(*result.settled, *desired.settled, 0.1);
  EXPECT_EQ(result.missed_steps, 0);
  // A picture's time determines the arm's position: an error of it would be an error of the estimate in
  // motion.
  for (const ServoStep& step : result.steps) {
    if (!step.seen_at) continue;
    const double frame = 30 * (*step.seen_at - 0.001);
    EXPECT_NEAR(frame, std::round(frame), 0.02) << "exposures begin 30 times in a second";
  }
}

TEST(OwnClocks, AServoDoesNotBeginWhereTheyAreNotMapped) {
  ServoBench bench(servo_file(servo_target));
  OwnClocks clocks(bench.ports(), clocks_ahead, clocks_drift);
  ServoNotes notes;
  const ServoResult result = bench.servo(clocks.own(), notes);
  EXPECT_NE(result.reason.find("the arm tells of a time that is 1000 s from now"), std::string::npos)
      << result.reason;
  EXPECT_TRUE(notes.sent.empty());
}

TEST(OwnClocks, ACalibrationGoesAsByTheRigsClock) {
  const std::string file = small_calibration(
      "images = 6\npose = [{ bends = [[0, 0], [0, 0], [0, 0]] }, { bends = [[0.5, 0.3], [-0.4, 0.6], [0.7, "
      "-0.5]] }, { bends = [[-0.6, 0.2], [0.3, -0.7], [0.2, 0.8]] }]\n",
      wrong_cameras);
  CalibrationBench plain(file), bench(file);
  OwnClocks clocks(bench.ports(), clocks_ahead, clocks_drift);
  const RigSessionResult desired = plain.calibrate_bundle(plain.ports());
  const RigSessionResult result = bench.calibrate_bundle(clocks.mapped(sensors_of(bench.experiment())));
  ASSERT_TRUE(desired.is_done) << desired.reason;
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_EQ(result.looks, desired.looks);
  EXPECT_LT(std::abs(bench.truth(result.target).angle), 0.01);
}

}  // namespace
}  // namespace flexura
