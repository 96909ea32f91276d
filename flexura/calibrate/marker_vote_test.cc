#include "flexura/calibrate/marker_vote.h"

#include <gtest/gtest.h>

#include <vector>

#include "flexura/model/backbone.h"
#include "tests/support/banded_arms.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

TEST(LikelyErrors, AreTheCamerasWhereItIsTurnedAndItsLensIsLonger) {
  for_random_cases(20, [](TestRandom& random) {
    const RigModel believed = believed_rig();
    const SightError error{random.vector<3>(-0.1, 0.1), random.uniform(-0.1, 0.1)};
    std::vector<MarkerPicture> pictures;
    for (const ArmState& pose : some_poses()) {
      const Backbone backbone(believed.arm, pose);
      MarkerPicture& picture = pictures.emplace_back();
      picture.view = view_of(believed, {.camera = 0});
      picture.ends = {backbone.pose(0).position, backbone.tip().position};
      for (const KnownMarker& marker : bands())
        picture.markers.push_back({backbone.pose(marker.s).position, marker.color});
      picture.seen = expected_scene(picture, error);
    }
    const auto found = likely_errors(pictures, rough, 3);
    ASSERT_FALSE(found.empty());
    // What is guessed counts a little.
    EXPECT_LT((found.front().turn - error.turn).norm(), 6e-3);
    EXPECT_NEAR(found.front().scale, error.scale, 6e-3);
  });
}

TEST(LikelyErrors, AreNoneWhereThereIsNoPicture) { EXPECT_TRUE(likely_errors({}, rough, 3).empty()); }

}  // namespace
}  // namespace flexura
