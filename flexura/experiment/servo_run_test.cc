// Tests the session configuration of a task in a file.
#include "flexura/tasks/servo/servo_run.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <variant>

#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

// Each setting differs from its default and from all others.
TEST(ServoConfig, HasEverySettingOfItsTask) {
  ServoSetup rig;
  rig.rest = "[[obstacle]]\nkind = \"sphere\"\ncenter = [3, 3, 3]\nradius = 0.1\n";
  const ServoConfig config =
      ServoBench(
          servo_file("cameras = [\"side\", \"front\"]\nlaw = \"chords\"\ntrack = \"model\"\nmeasure = "
                     "\"flow\"\nanchor = 0.21\n"
                     "jacobian = \"recursive\"\npoints = 7\nrate = 3.5\ndamping = 0.023\npredict = false\n"
                     "tolerance = 0.013\nsettle = 0.7\ntimeout = 11\nhold_after = 0.4\ngive_up_after = "
                     "2.5\nfollow = true\n"
                     "camera_prior = { rotation_std = 0.03, focal_std = 0.05 }\nstep = "
                     "0.04\n[[task.target]]\ntime = 0.6\n"
                     "bends = [[0.1, 0], [0.2, 0], [0.3, 0]]\n",
                     rig))
          .config();
  EXPECT_EQ(config.cameras, (std::array<std::size_t, 2>{1, 0}));
  EXPECT_EQ(config.law, ServoLawKind::chords);
  EXPECT_EQ(config.track, ServoTracking::model);
  EXPECT_EQ(config.measure, ServoMeasure::flow);
  EXPECT_EQ(config.anchor, 0.21);
  EXPECT_EQ(config.jacobian, ServoJacobian::recursive);
  EXPECT_EQ(config.points, 7);
  EXPECT_EQ(config.rate, 3.5);
  EXPECT_EQ(config.damping, 0.023);
  EXPECT_FALSE(config.predict);
  EXPECT_EQ(config.tolerance, 0.013);
  EXPECT_EQ(config.settle, 0.7);
  EXPECT_EQ(config.timeout, 11);
  EXPECT_EQ(config.hold_after, 0.4);
  EXPECT_EQ(config.give_up_after, 2.5);
  EXPECT_TRUE(config.follow);
  EXPECT_EQ(config.camera_prior.rotation_std, 0.03);
  EXPECT_EQ(config.camera_prior.focal_std, 0.05);
  EXPECT_EQ(config.step, 0.04);
  EXPECT_EQ(config.list_step, 0.05) << "the clock's";
  EXPECT_EQ(config.obstacles.size(), 1U);
  EXPECT_FALSE(config.drive);
  EXPECT_TRUE(config.markers.empty()) << "gray cameras tell no bands";
  ASSERT_EQ(config.goals.size(), 1U);
  EXPECT_EQ(config.goals[0].time, 0.6);
  EXPECT_EQ(std::get<ArmState>(config.goals[0].shape).bends[2].x(), 0.3);
}

// A picture every fifth of a second: between two of them the servo must not count as blind, whatever the
// task's settings.
TEST(ServoConfig, WaitsForThePicturesOfItsSlowerCamera) {
  std::string file = servo_file("hold_after = 0.1\ngive_up_after = 0.4\n" + servo_target);
  file.replace(file.rfind("frame_rate = 30"), 15, "frame_rate = 5");
  const ServoConfig config = ServoBench(file).config();
  EXPECT_EQ(config.step, 0.2);
  EXPECT_NEAR(config.hold_after, 0.3, 1e-15);
  EXPECT_NEAR(config.give_up_after, 0.6, 1e-15);
}

}  // namespace
}  // namespace flexura
