// Difficult arms: under hairs, upside down, in front of uneven screens, beside others, crossing themselves,
// turned towards the camera, through lenses with distortion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "tests/support/plain_arms.h"

namespace flexura {
namespace {

using testing::HasSubstr;

// Two pixels wide, from one column to another. A hair from border to border consists of many short runs, in
// most of the figure's rows.
struct Hair {
  int from, to;
  double v, slope;
};

TEST(HardArms, GoesOnUnderHairs) {
  for (const std::vector<Hair>& hairs : {std::vector<Hair>{{100, 540, 220, 1 / 9.0}},
                                         {{0, 640, 100, 0}},
                                         {{0, 640, 100, 140 / 640.0}},
                                         {{0, 640, 100, 370 / 640.0}},
                                         {{0, 640, 150, 30 / 640.0}, {0, 640, 250, 30 / 640.0}}}) {
    SeenArm seen = plain_arm(0.6);
    for (const Hair& hair : hairs)
      for (int u = hair.from; u < hair.to; ++u)
        for (int k = 0; k < 2; ++k) seen.picture.at(u, static_cast<int>(hair.v + hair.slope * u) + k) = 30;
    ArmFinder finder;
    const ArmObservation& found = finder.find(seen.picture);
    ASSERT_TRUE(found.is_found()) << found.reason;
    EXPECT_LT(rms_error(seen, found.axis), 0.1) << hairs.front().slope;
    if (hairs.front().from == 0) continue;
    EXPECT_LT((found.axis.back().pixel - *seen.truth.back().pixel).norm(), 0.5);
    EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 0.5);
  }
}

// The axis of the rotated picture is the rotated axis.
TEST(HardArms, SeesAnArmUpsideDown) {
  const SeenArm seen = plain_arm(0.6);
  Image<std::uint8_t> turned = seen.picture;
  std::ranges::reverse(turned.values());
  ArmFinder finder;
  const auto upright = finder.find(seen.picture).axis;
  const ArmObservation& found = finder.find(turned);
  ASSERT_TRUE(found.is_found()) << found.reason;
  // The base is the lower end in a picture.
  const Eigen::Vector2d corner(seen.picture.width() - 1, seen.picture.height() - 1);
  EXPECT_LT((corner - found.axis.front().pixel - upright.back().pixel).norm(), 0.3);
  EXPECT_LT((corner - found.axis.back().pixel - upright.front().pixel).norm(), 0.3);
  for (const AxisSample& sample : found.axis) {
    if (!sample.is_seen) continue;
    const auto nearest = std::ranges::min_element(
        upright, {}, [&](const AxisSample& other) { return (corner - sample.pixel - other.pixel).norm(); });
    EXPECT_LT(std::abs((corner - sample.pixel - nearest->pixel).dot(nearest->normal)), 0.1);
  }
}

TEST(HardArms, ByBlockSeesAnArmBeforeAnUnevenScreen) {
  ArmFinderConfig config;
  config.threshold.method = ThresholdMethod::by_block;
  ArmFinder by_block(config);
  const SeenArm plain = plain_arm(0.6);
  const auto at = [&](double u, double v) {
    return Eigen::Vector2d(u / plain.view.width, v / plain.view.height);
  };
  const auto side = [&](double u, double v) { return 0.2 + 0.75 * at(u, v).x(); };
  const auto above = [&](double u, double v) { return 0.95 - 0.7 * at(u, v).y(); };
  const auto corners = [&](double u, double v) {
    return 1 - 1.5 * (at(u, v) - Eigen::Vector2d(0.5, 0.5)).squaredNorm();
  };
  const auto expect_found = [&](const auto& light) {
    SeenArm seen = plain;
    for (int v = 0; v < seen.view.height; ++v)
      for (int u = 0; u < seen.view.width; ++u)
        // The darkest part, 30 of 255, has a third of the local screen brightness.
        seen.picture.at(u, v) =
            static_cast<std::uint8_t>(std::lround((60 + 0.65 * seen.picture.at(u, v)) * light(u, v)));
    const ArmObservation& found = by_block.find(seen.picture);
    ASSERT_TRUE(found.is_found()) << found.reason;
    EXPECT_EQ(found.threshold.figure, Figure::dark);
    EXPECT_LT((found.axis.back().pixel - *seen.truth.back().pixel).norm(), 1.5);
    EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 1.5);
    EXPECT_LT(rms_error(seen, found.axis), 0.15);
  };
  expect_found(side);
  expect_found(above);
  expect_found(corners);
  // A shaded screen alone shows no arm.
  Image<std::uint8_t> empty(640, 480);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) empty.at(u, v) = static_cast<std::uint8_t>(std::lround(200 * side(u, v)));
  EXPECT_NE(by_block.find(empty).reason, "");
}

TEST(HardArms, MeasuresTheLargerOfTwoArmsAndSaysSo) {
  const SeenArm one = plain_arm(0.3);
  Image<std::uint8_t> both = one.picture;
  // A second arm, half as long, 150 px beside it.
  for (int v = 0; v < both.height() / 2; ++v)
    for (int u = 0; u + 150 < both.width(); ++u)
      both.at(u + 150, v) = std::min(both.at(u + 150, v), one.picture.at(u, v));
  ArmFinder finder;
  const ArmObservation& found = finder.find(both);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT(rms_error(one, found.axis), 0.1);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("1 other figure of similar size")));
}

TEST(HardArms, FollowsAnArmAcrossItself) {
  // A loop in the plane of the picture, the later part of it in front of the earlier.
  const SeenArm seen =
      bent_arm_in_view({{0.4, 0}, {4.6, 0.5}, {0.4, 0}}, 0.008, {-0.03, 0.35, 1.6}, {-0.03, 0.35, 0}, 800);
  ArmFinder finder;
  const ArmObservation& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT((found.axis.back().pixel - *seen.truth.back().pixel).norm(), 2);
  EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 2);
  EXPECT_LT(rms_error(seen, found.axis), 0.3);
}

TEST(HardArms, SaysWhereAnArmPointsAtTheCamera) {
  // The last section turns towards the camera on Z.
  const SeenArm seen = bent_arm_in_view({{0, 0}, {0, 0}, {0, 1.5}}, 0.02, {0, 0.45, 1.8}, {0, 0.45, 0}, 800);
  ArmFinder finder;
  const ArmObservation& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  // The reported axis is correct and extends to where the arm turns.
  EXPECT_LT(rms_error(seen, found.axis), 1);
  EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 1);
  const auto turns = seen.truth.begin() + static_cast<std::ptrdiff_t>(2 * seen.truth.size() / 3);
  EXPECT_GT((found.axis.back().pixel - found.axis.front().pixel).norm(),
            0.8 * (*turns->pixel - *seen.truth.front().pixel).norm());
  const AxisEnd& tip = found.ends[1];
  if (tip.kind == AxisEndKind::lost) {
    EXPECT_NE(std::ranges::find_if(found.notes,
                                   [](const std::string& note) {
                                     return note.find("points at the camera") != std::string::npos;
                                   }),
              found.notes.end());
  } else {
    EXPECT_EQ(tip.kind, AxisEndKind::free);
    EXPECT_LT((tip.pixel - *seen.truth.back().pixel).norm(), 5 * tip.sigma + 1);
  }
}

// Bent so much that many tips hide behind the arm or turn sharply in the picture.
TEST(HardArms, HaveNoFreeEndsWhereTheyGoOn) {
  ArmFinder finder;
  int count = 0, near = 0, far = 0, whole = 0, whole_near = 0;
  for_random_cases(60, [&](TestRandom& random) {
    SeenArmConfig options;
    options.most_bend = 1.8;
    options.psf = random.uniform(0.7, 2);
    const SeenArm seen = random_seen_arm(random, options);
    const ArmObservation& found = finder.find(seen.picture);
    if (!found.is_found()) return;
    for (const AxisEnd& end : found.ends) {
      if (end.kind != AxisEndKind::free) continue;
      const double off = std::min((end.pixel - *seen.truth.front().pixel).norm(),
                                  (end.pixel - *seen.truth.back().pixel).norm());
      ++count, near += off < 1, far += off > 4;
      if (found.covered >= 0.96) ++whole, whole_near += off < 1;
    }
  });
  std::printf("free ends: %d, within 1 px %d, more than 4 px off %d; of whole arms %d, %d\n", count, near,
              far, whole, whole_near);
  EXPECT_GT(count, 70 / one_case_of);
  // Ends that turn towards the camera look rounder than they are; a tip hidden behind the arm is invisible.
  EXPECT_LE(count - near, 1 + 0.15 * count);
  EXPECT_LE(whole - whole_near, 1 + 0.03 * whole);
  EXPECT_LE(far, 2 + 0.01 * count);
}

}  // namespace
}  // namespace flexura
