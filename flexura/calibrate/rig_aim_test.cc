#include "flexura/calibrate/rig_aim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "flexura/camera/camera.h"
#include "tests/support/random_cases.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

constexpr double step = 0.075 * degree;

// A rig as calibrations find them: nothing is where it was meant to be.
RigModel found_rig(TestRandom& random) {
  RigModel model = true_rig(believed_rig(), {}, random);
  for (CameraConfig& camera : model.cameras) {
    camera.head.pan.zero = random.uniform(-0.02, 0.02), camera.head.tilt.zero = random.uniform(-0.02, 0.02);
    for (double& offset : camera.head.pupil) offset = random.uniform(-0.05, 0.05);
    for (double& offset : camera.head.tilt_axis) offset = random.uniform(-0.05, 0.05);
    camera.head.pupil_shift = random.uniform(-0.005, 0.005);
  }
  return model;
}

RigWish wish_for(TestRandom& random) {
  RigWish wish;
  wish.target = {0, 0.5, 0};
  wish.now = {RigStance{0, {0, 0, random.uniform(1, 2.5)}, {}},
              RigStance{1, {0, 0, random.uniform(1, 2.5)}, {}}};
  return wish;
}

TEST(Aim, BringsThePointOntoTheAxis) {
  for_random_cases(200, [](TestRandom& random) {
    const RigModel model = found_rig(random);
    const Eigen::Vector3d target = random.vector<3>(-0.3, 0.6);
    const RigStance stance{1, {0, 0, random.uniform(1, 3)}, {random.vector<3>(-0.3, 0.3)}};
    const HeadState head = aimed(model.cameras[1], stance, target);
    const Pose X_WC = Camera(model.cameras[1]).pose(stance.stage, head);
    EXPECT_LE((X_WC.inverse() * target).head<2>().norm(), 1e-12);
    EXPECT_GT((X_WC.inverse() * target).z(), 0);
  });
}

TEST(WantedRig, IsReachedExactlyWhereNothingHasSteps) {
  for_random_cases(50, [](TestRandom& random) {
    RigModel model = found_rig(random);
    for (CameraConfig& camera : model.cameras) camera.head.pan.resolution = camera.head.tilt.resolution = 0;
    const WantedRig wanted = wanted_rig(model, wish_for(random));
    EXPECT_TRUE(wanted.notes.empty());
    EXPECT_NEAR(wanted.remainder.angle, 0, 1e-10);
    for (const Eigen::Vector2d& aim : wanted.remainder.aim) EXPECT_LE(aim.norm(), 1e-10);
    EXPECT_NEAR(wanted.remainder.zoom_ratio, 1, 1e-4);  // The pupils' shift is followed in five rounds.
    for (std::size_t i = 0; i < 2; ++i) {
      const auto limits = Camera(model.cameras[i]).stage_axes()[0].limits;
      EXPECT_LE(wanted.stances[i].stage.offset.cwiseAbs().maxCoeff(), limits[1]);
    }
  });
}

TEST(WantedRig, IsOrthogonalWithinHalfAStepOfTheHeads) {
  for_random_cases(100, [](TestRandom& random) {
    const RigModel model = found_rig(random);
    const WantedRig wanted = wanted_rig(model, wish_for(random));
    EXPECT_LE(std::abs(wanted.remainder.angle), 0.51 * step);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LE(wanted.remainder.aim[i].norm(), 2 * step * 3.2);
      const HeadState& head = wanted.stances[i].head;
      EXPECT_EQ(head, commanded_head(model.cameras[i], head));
    }
  });
}

TEST(WantedRig, TurnsTheHeadsWhereTheStagesCannot) {
  for_random_cases(20, [](TestRandom& random) {
    RigModel model = found_rig(random);
    RigWish wish = wish_for(random);
    wish.may_use_stages = false;
    for (CameraConfig& camera : model.cameras) camera.head.pan.resolution = camera.head.tilt.resolution = 0;
    const WantedRig wanted = wanted_rig(model, wish);
    EXPECT_NEAR(wanted.remainder.angle, 0, 1e-10);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(wanted.stances[i].stage, wish.now[i].stage);
    const double passed = std::max(wanted.remainder.aim[0].norm(), wanted.remainder.aim[1].norm());
    EXPECT_EQ(passed > 0.5e-3 * 2.8, !wanted.notes.empty()) << passed;
  });
}

TEST(WantedRig, SaysWhichAxisEndsTooEarly) {
  TestRandom random(1);
  RigModel model = found_rig(random);
  model.cameras[0].head.pan.limits = {0.5, 1};
  const WantedRig wanted = wanted_rig(model, wish_for(random));
  ASSERT_FALSE(wanted.notes.empty());
  EXPECT_EQ(wanted.notes[0].substr(0, 10), "front: pan") << testing::PrintToString(wanted.notes);
  EXPECT_NEAR(wanted.stances[0].head.pan, 0.5, step);
}

TEST(WantedRig, ReportsTheRollThatNoHeadCorrects) {
  RigModel model = believed_rig();
  model.cameras[0].mount.roll = 0.02;
  RigWish wish;
  wish.target = {0, 0.5, 0};
  wish.now = {RigStance{0, {}, {}}, RigStance{1, {}, {}}};
  const WantedRig wanted = wanted_rig(model, wish);
  EXPECT_NEAR(wanted.remainder.roll[0], 0.02, 1e-9);
  EXPECT_NEAR(wanted.remainder.roll[1], 0, 1e-9);
  wish.now[1].camera = 0;
  EXPECT_THROW((void)wanted_rig(model, wish), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
