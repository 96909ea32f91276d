#include <gtest/gtest.h>

#include "tests/support/servo_trials.h"

namespace flexura {
namespace {

TEST(ServoLoop, BringsTheArmToRandomTargets) { expect_random_targets(200); }

TEST(ServoLoop, OfSilhouettesReachesWhatPointsReach) { expect_silhouettes_reach_what_points_reach(200); }

TEST(ServoLoop, BringsTheArmToTargetsNearByWithMomentsAlone) { expect_moments_alone(100, 0.95); }

TEST(ServoLoop, ReachesWhatTheSameCamerasRecordedHoweverWrongTheyAreBelievedToBe) {
  expect_targets_of_wrong_cameras(200);
}

TEST(ServoLoop, LearnsAnArmOfWhichItIsTaughtWrong) { expect_turned_arm_is_learned(40, 0.95); }

}  // namespace
}  // namespace flexura
