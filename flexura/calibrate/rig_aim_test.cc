#include "flexura/calibrate/rig_aim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

using ::testing::Contains, ::testing::Not;

constexpr double step = 0.075 * degree;

// A rig as calibrations find it, with errors everywhere.
RigModel found_rig(TestRandom& random) {
  RigModel model = true_rig(nominal_rig(), {}, random);
  for (CameraConfig& camera : model.cameras) {
    camera.head.pan.zero = random.uniform(-0.02, 0.02), camera.head.tilt.zero = random.uniform(-0.02, 0.02);
    for (double& offset : camera.head.pupil) offset = random.uniform(-0.05, 0.05);
    for (double& offset : camera.head.tilt_axis) offset = random.uniform(-0.05, 0.05);
    camera.head.pupil_shift = random.uniform(-0.005, 0.005);
  }
  return model;
}

RigGoal goal_for(TestRandom& random) {
  RigGoal rig_goal;
  rig_goal.target = {0, 0.5, 0};
  rig_goal.now = {RigStance{0, {0, 0, random.uniform(1, 2.5)}, {}},
                  RigStance{1, {0, 0, random.uniform(1, 2.5)}, {}}};
  return rig_goal;
}

TEST(Aim, BringsThePointOntoTheAxis) {
  for_random_cases(200, [](TestRandom& random) {
    const RigModel model = found_rig(random);
    const Eigen::Vector3d target = random.vector<3>(-0.3, 0.6);
    const RigStance stance{1, {0, 0, random.uniform(1, 3)}, {random.vector<3>(-0.3, 0.3)}};
    const HeadState head = aimed(model.cameras[1], stance, target);
    const Pose X_WC = Camera(model.cameras[1]).pose({head, stance.stage});
    EXPECT_LE((X_WC.inverse() * target).head<2>().norm(), 1e-12);
    EXPECT_GT((X_WC.inverse() * target).z(), 0);
  });
}

MountConfig looking_down_z() {
  MountConfig mount;
  mount.look_at = {{0, 0, -1}};
  return mount;
}

// The camera's position is known from each picture; the rotation of its mount is modelled wrong by `turn`.
// Returns the distance of the pupil from its target after each move.
std::vector<double> distances_by_stage(const Eigen::Vector3d& turn, const Eigen::Vector3d& start, int moves) {
  const MountConfig mount = looking_down_z();
  CameraConfig truth, nominal;
  truth.mount = nominal.mount = mount;
  const Eigen::Quaterniond wrong(so3_exp(turn) * mount.pose().rotation);
  nominal.mount.look_at.reset(), nominal.mount.rotation = {{wrong.w(), wrong.x(), wrong.y(), wrong.z()}};
  RigStance stance{0, {0, 0, 1}, {start}};
  const Eigen::Vector3d desired = Camera(truth).pose({stance.head, {}}).position;
  std::vector<double> distances;
  for (int i = 0; i <= moves; ++i) {
    const Eigen::Vector3d now = Camera(truth).pose(stance.stance()).position;
    distances.push_back((now - desired).norm());
    const Eigen::Vector3d off = now - Camera(nominal).pose(stance.stance()).position;
    for (std::size_t k = 0; k < 3; ++k) nominal.mount.position[k] += off[static_cast<Eigen::Index>(k)];
    stance.stage.offset = stage_towards(nominal, stance, desired);
  }
  return distances;
}

// |I - R| = 2 sin(angle / 2), across the axis of R.
TEST(StageTowards, ClosesInWhereTheMountsTurnIsKnownWithin60DegreesAndNowhereElse) {
  for_random_cases(300, [](TestRandom& random) {
    const Eigen::Vector3d axis = random.vector<3>(-1, 1).normalized();
    const double angle = random.uniform(1, 59.9) * degree, least = random.uniform(60.1, 179) * degree;
    const Eigen::Vector3d start = random.vector<3>(-1, 1);
    const double by = 2 * std::sin(0.5 * angle);
    constexpr int moves = 10;
    const std::vector<double> closer = distances_by_stage(angle * axis, start, moves);
    for (std::size_t i = 1; i <= moves; ++i) EXPECT_LE(closer[i], by * closer[i - 1] + 1e-12);
    // An offset along the axis vanishes; one across it grows.
    const Eigen::Matrix3d R_WM = looking_down_z().pose().rotation;
    const Eigen::Vector3d across = R_WM.transpose() * axis.cross(random.vector<3>(-1, 1)).normalized();
    const std::vector<double> farther = distances_by_stage(least * axis, across, moves);
    for (std::size_t i = 1; i <= moves; ++i)
      EXPECT_NEAR(farther[i] / farther[i - 1], 2 * std::sin(0.5 * least), 1e-9);
  });
}

TEST(DesiredRig, IsReachedExactlyWhereNothingHasStepsAndWithinHalfAStepOfHeads) {
  for_random_cases(50, [](TestRandom& random) {
    RigModel model = found_rig(random);
    RigGoal rig_goal = goal_for(random);
    const DesiredRig in_steps = desired_rig(model, rig_goal);
    EXPECT_LE(std::abs(in_steps.remainder.angle), 0.51 * step);
    for (const Eigen::Vector2d& aim : in_steps.remainder.aim) EXPECT_LE(aim.norm(), 2 * step * 3.2);
    for (const RigStance& stance : in_steps.stances)
      EXPECT_EQ(stance.head, commanded(Camera(model.cameras[stance.camera]), stance).head);
    for (CameraConfig& camera : model.cameras) camera.head.pan.resolution = camera.head.tilt.resolution = 0;
    const DesiredRig desired = desired_rig(model, rig_goal);
    EXPECT_TRUE(desired.notes.empty());
    EXPECT_NEAR(desired.remainder.angle, 0, 1e-10);
    for (const Eigen::Vector2d& aim : desired.remainder.aim) EXPECT_LE(aim.norm(), 1e-10);
    EXPECT_NEAR(desired.remainder.zoom_ratio, 1, 1e-4);  // Five rounds follow the shift of the pupils.
    for (std::size_t i = 0; i < 2; ++i) {
      const auto limits = Camera(model.cameras[i]).stage_axes()[0].limits;
      EXPECT_LE(desired.stances[i].stage.offset.cwiseAbs().maxCoeff(), limits[1]);
    }
    // The heads make up for the stages.
    rig_goal.may_use_stages = false;
    const DesiredRig turned = desired_rig(model, rig_goal);
    EXPECT_NEAR(turned.remainder.angle, 0, 1e-10);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(turned.stances[i].stage, rig_goal.now[i].stage);
    const double passed = std::max(turned.remainder.aim[0].norm(), turned.remainder.aim[1].norm());
    EXPECT_EQ(passed > 0.5e-3 * 2.8, !turned.notes.empty()) << passed;
  });
}

TEST(DesiredRig, SaysWhichAxisEndsTooEarly) {
  TestRandom random(1);
  RigModel model = found_rig(random);
  model.cameras[0].head.pan.limits = {0.5, 1};
  const DesiredRig desired = desired_rig(model, goal_for(random));
  ASSERT_FALSE(desired.notes.empty());
  EXPECT_EQ(desired.notes[0].substr(0, 10), "front: pan") << testing::PrintToString(desired.notes);
  EXPECT_NEAR(desired.stances[0].head.pan, 0.5, step);
}

TEST(DesiredRig, SaysWhereNoZoomOfBothShowsTheTargetAlike) {
  TestRandom random(1);
  RigModel model = found_rig(random);
  const std::string reported = "the zoom ranges of the cameras do not allow equal sizes of the target";
  EXPECT_THAT(desired_rig(model, goal_for(random)).notes, Not(Contains(reported)));
  model.cameras[0].head.zoom.limits = {1, 1.2}, model.cameras[1].head.zoom.limits = {2, 3};
  const DesiredRig desired = desired_rig(model, goal_for(random));
  EXPECT_THAT(desired.notes, Contains(reported));
  EXPECT_EQ(desired.stances[0].head.zoom, 1.2);
  EXPECT_EQ(desired.stances[1].head.zoom, 2);
}

TEST(DesiredRig, ReportsTheRollThatNoHeadCorrects) {
  RigModel model = nominal_rig();
  model.cameras[0].mount.roll = 0.02;
  RigGoal rig_goal;
  rig_goal.target = {0, 0.5, 0};
  rig_goal.now = {RigStance{0, {}, {}}, RigStance{1, {}, {}}};
  const DesiredRig desired = desired_rig(model, rig_goal);
  EXPECT_NEAR(desired.remainder.roll[0], 0.02, 1e-9);
  EXPECT_NEAR(desired.remainder.roll[1], 0, 1e-9);
  rig_goal.now[1].camera = 0;
  EXPECT_THROW((void)desired_rig(model, rig_goal), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
