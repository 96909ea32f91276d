#include "flexura/view/viewed_rig.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

// The true arm stands slightly higher than the model; the second camera exposes for 10 ms.
const std::string lifted_text = viewed_text + "[truth.arm.base]\nposition = [0, 0.1, 0]\n";

std::vector<Instant> swing(double start, double end) {
  return {{start, {{{0.2, 0}, {0, 0}}, {1, 1}}, {{0, 0, 1}, {}}},
          {end, {{{0.6, 0}, {0, 0.4}}, {1, 1}}, {{0.2, -0.1, 1}, {}}}};
}

TEST(ViewedRig, IsShownInPicturesAsItTrulyIsAndNotAsItIsBelievedToBe) {
  const ViewedRigPtr rig = viewed_rig(lifted_text);
  const std::vector<Instant> instants = swing(0, 1);
  const ValueShot shot = value_shot(rig, 0, 0, 0, {instants[0]});
  const Eigen::Vector3d tip = shot.shot.backbone(0).tip().position;
  EXPECT_LT((tip - rig->truth.backbone(instants[0].arm).tip().position).norm(), 1e-12);
  EXPECT_NEAR((tip - rig->model.backbone(instants[0].arm).tip().position).norm(), 0.1, 1e-12);
}

TEST(ViewedRig, IsShownBetweenTwoInstantsInBetween) {
  const ViewedRigPtr rig = viewed_rig(lifted_text);
  const ValueShot shot = value_shot(rig, 1, 0, 3, swing(3, 3.01));
  const ArmState arm = {{{0.3, 0}, {0, 0.1}}, {1, 1}};  // A quarter of the way.
  EXPECT_LT((shot.shot.backbone(3.0025).tip().position - rig->truth.backbone(arm).tip().position).norm(),
            1e-12);
  const View view = shot.shot.view(3.0025), there = rig->cameras[1].view({{0.05, -0.025, 1}, {}});
  EXPECT_LT((view.X_WC.rotation - there.X_WC.rotation).norm(), 1e-12);
  // The reported axis positions are those at mid-exposure.
  EXPECT_NEAR(stance_in(shot).head.pan, 0.1, 1e-12);
  EXPECT_NEAR(stance_in(shot).head.tilt, -0.05, 1e-12);
}

TEST(ViewedRig, IsKnownFromTheStartOfAnExposureToItsEnd) {
  const ViewedRigPtr rig = viewed_rig();
  const std::vector<double> times = times_of_instants(rig->sensors[1], 3);
  EXPECT_EQ(times.front(), 3);
  EXPECT_NEAR(times.back(), 3.01, 1e-12);
  ASSERT_GT(times.size(), 10U);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_LT(times[i] - times[i - 1], 0.002);
  SensorConfig at_once = rig->sensors[1];
  at_once.exposure = 0;
  EXPECT_EQ(times_of_instants(at_once, 3), std::vector<double>{3});
}

}  // namespace
}  // namespace flexura
