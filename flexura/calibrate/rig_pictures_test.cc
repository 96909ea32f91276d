// Identification of markers by one picture alone and by all pictures of a camera together.
#include "flexura/calibrate/rig_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tests/support/banded_arms.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

// A row of equal markers, partly visible: shifted by one it looks identical.
TEST(MarkerMatch, TakesTheLikelierOfTwoShifts) {
  MarkerScene expected, seen;
  for (int i = 0; i < 12; ++i) {
    expected.markers.emplace_back(MarkerScene::Place{{320.0, 40.0 * i + 20}});
    if (i >= 2 && i < 9) seen.markers.emplace_back(MarkerScene::Place{{324.0, 40.0 * i + 23}});
  }
  const MarkerMatch match =
      match_markers(expected, seen, {640, 480}, {.shift = 10, .turn = 0.05, .scale = 0.05});
  EXPECT_EQ(match.count, 7U);
  for (std::size_t i = 0; i < match.markers.size(); ++i) EXPECT_EQ(match.markers[i], i + 2);
}

TEST(LikelyErrors, AreTheCamerasWhereItIsTurnedAndItsLensIsLonger) {
  for_random_cases(20, [](TestRandom& random) {
    const RigModel nominal = nominal_rig();
    const PointingError error{random.vector<3>(-0.1, 0.1), random.uniform(-0.1, 0.1)};
    std::vector<MarkerPicture> pictures;
    for (const ArmState& pose : some_poses()) {
      MarkerPicture& picture = pictures.emplace_back(
          marker_picture(nominal.arm, pose, bands(), view_of(nominal, {.camera = 0}), nominal.arm));
      picture.seen = expected_scene(picture, error);
    }
    const auto found = likely_errors(pictures, rough, 3);
    ASSERT_FALSE(found.empty());
    // The prior pulls the estimate slightly.
    EXPECT_LT((found.front().turn - error.turn).norm(), 6e-3);
    EXPECT_NEAR(found.front().scale, error.scale, 6e-3);
  });
  EXPECT_TRUE(likely_errors({}, rough, 3).empty());
}

// True view of an arm and the true identities of its markers; some are missed, some are false detections.
struct TrueObservation {
  MarkerScene scene;
  std::vector<std::optional<std::size_t>> names;
};

TrueObservation look(const RigModel& truth, const Arm& given, const RigStance& stance, const ArmState& pose,
                     TestRandom& random) {
  const View view = view_of(truth, stance);
  const MarkerScene all = expected_markers(truth.arm, truth.bent(pose), bands(), view, given);
  const auto is_inside = [&](const std::optional<Eigen::Vector2d>& at) {
    return at && at->minCoeff() > 2 && at->x() < view.width - 3 && at->y() < view.height - 3;
  };
  TrueObservation observed;
  for (std::size_t i = 0; i < all.markers.size(); ++i) {
    if (!all.markers[i] || !is_inside(all.markers[i]->pixel)) continue;
    if (random.uniform(0, 1) < 0.08) continue;
    observed.scene.markers.emplace_back(
        MarkerScene::Place{all.markers[i]->pixel + random.vector<2>(-0.3, 0.3), all.markers[i]->color});
    observed.names.emplace_back(i);
    if (random.uniform(0, 1) > 0.03) continue;
    observed.scene.markers.emplace_back(
        MarkerScene::Place{all.markers[i]->pixel + random.vector<2>(-30, 30),
                           band_colors[static_cast<std::size_t>(random.integer(0, 2))]});
    observed.names.emplace_back();
  }
  if (is_inside(all.ends[0]) && is_inside(all.ends[1])) observed.scene.ends = all.ends;
  return observed;
}

// Number of misidentified markers.
int wrong_ones(const MarkerMatch& match, const TrueObservation& observed) {
  int wrong = 0;
  for (std::size_t i = 0; i < observed.names.size(); ++i)
    if (match.markers[i] && match.markers[i] != observed.names[i]) ++wrong;
  return wrong;
}

struct Session {
  RigModel nominal = nominal_rig(), truth;
  RigPictures rig_pictures{nominal.arm, {.markers = bands()}, {0, 1}};
  std::vector<TrueObservation> seen;

  explicit Session(TestRandom& random) : truth(true_rig(nominal, {}, random)) {
    rig_pictures.poses = some_poses();
  }
  void take(const RigStance& stance, std::size_t pose, TestRandom& random) {
    rig_pictures.stances.push_back(stance);
    seen.push_back(look(truth, nominal.arm, stance, rig_pictures.poses[pose], random));
    ArmFigure figure;
    figure.scene = seen.back().scene, figure.size = {640, 480};
    rig_pictures.looks.push_back(
        {.stance = rig_pictures.stances.size() - 1, .pose = pose, .arm = std::move(figure)});
  }
};

// With lenses that show a part of the arm, and the roughest allowed guesses.
TEST(RigPictures, TogetherTellMarkersThatOnePictureTakesForOthers) {
  constexpr int trials = 100;
  int looks = 0, misled = 0, misled_alone = 0, recognised = 0, markers = 0;
  for (int trial = 0; trial < trials; ++trial) {
    TestRandom random(case_seed(trial));
    Session session(random);
    for (const std::size_t camera : {std::size_t{0}, std::size_t{1}})
      for (std::size_t pose = 0; pose < 3; ++pose)
        session.take({.camera = camera, .head = {.zoom = 1.8}}, pose, random);
    const auto matches = session.rig_pictures.recognise(session.nominal, rough);
    for (std::size_t i = 0; i < session.seen.size(); ++i) {
      const TrueObservation& observed = session.seen[i];
      if (observed.scene.markers.size() < 5) continue;
      ++looks;
      if (wrong_ones(matches[i], observed) > 2) ++misled;
      recognised += static_cast<int>(matches[i].count), markers += static_cast<int>(observed.names.size());
      const RigPictures::Look& taken = session.rig_pictures.looks[i];
      const MarkerScene expected =
          expected_markers(session.nominal.arm, session.rig_pictures.poses[taken.pose], bands(),
                           view_of(session.nominal, session.rig_pictures.stances[taken.stance]));
      if (wrong_ones(match_markers(expected, observed.scene, {640, 480}), observed) > 2) ++misled_alone;
    }
  }
  RecordProperty("looks", looks), RecordProperty("misled", misled),
      RecordProperty("misled_alone", misled_alone);
  EXPECT_GT(looks, 4 * trials);
  EXPECT_GT(misled_alone, looks / 40) << "the case is too easy to tell anything";
  EXPECT_LE(4 * misled, misled_alone);
  EXPECT_GT(recognised, 0.9 * markers);
}

TEST(RigPictures, OfAKnownRigAreRecognisedFromWhereNothingWasSeenBefore) {
  for_random_cases(20, [](TestRandom& random) {
    Session session(random);
    for (std::size_t pose = 0; pose < 3; ++pose) session.take({.camera = 0}, pose, random);
    session.take({.camera = 0, .head = {.pan = 0.1, .tilt = -0.05, .zoom = 2}}, 2, random);
    const auto matches =
        session.rig_pictures.recognise(session.truth, {.sideways = 0.03, .roll = 0.02, .scale = 0.05});
    for (std::size_t i = 0; i < session.seen.size(); ++i) {
      const auto named =
          std::ranges::count_if(session.seen[i].names, [](const auto& one) { return one.has_value(); });
      EXPECT_LE(wrong_ones(matches[i], session.seen[i]), 1) << i;
      EXPECT_GE(static_cast<std::ptrdiff_t>(matches[i].count), named - 1) << i;
    }
  });
}

}  // namespace
}  // namespace flexura
