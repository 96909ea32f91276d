#include "flexura/vision/markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/vision/backbone_image.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/drawn_arms.h"
#include "tests/support/random_cases.h"
#include "tests/support/seen_arms.h"
#include "tests/support/study_numbers.h"

namespace flexura {
namespace {

using testing::HasSubstr;

const Color red = {0.85, 0.1, 0.1}, green = {0.1, 0.6, 0.1};

std::vector<MarkerRing> even_bands(double step) {
  std::vector<MarkerRing> bands;
  for (double s = 0.08; s < 0.75; s += step) bands.push_back({s - 0.008, s + 0.008, red});
  return bands;
}

// A slightly bent arm of 0.8 m, fully in view, with these bands.
class BandedPicture {
 public:
  explicit BandedPicture(const std::vector<MarkerRing>& bands) {
    BentArm bent;
    bent.arm.kind = ArmKind::spatial;
    for (int i = 0; i < 2; ++i) bent.arm.sections.push_back({.length = 0.4, .radius = {0.02, 0.02}});
    bent.state = ArmState::straight(2);
    bent.state.bends = {{0, 0.5}, {0.2, -0.4}};
    scene.background = Color::Constant(0.85);
    scene.arm.tube = tube_of(bent.backbone());
    scene.arm.albedo = {0.08, 0.08, 0.09};
    scene.arm.markers = bands;
    options.color = true;
    view = pinhole_view(look_at({0, 0.4, 1.6}, {0, 0.4, 0}), options.width, options.height, 800);
    picture = photograph(scene, view, options, 1);
  }

  [[nodiscard]] MarkerObservations found() const {
    ArmFinder finder;
    ArmObservation arm = finder.find(gray_picture(picture));
    EXPECT_TRUE(arm.is_found()) << arm.reason;
    to_backbone_image(view.lens, arm.axis);
    return find_markers(picture, arm);
  }
  // True image position of the middle of band i.
  [[nodiscard]] Eigen::Vector2d middle(std::size_t i) const {
    Renderer renderer;
    renderer.prepare(scene, view);
    const MarkerRing& ring = scene.arm.markers[i];
    const std::vector<double> place = {0.5 * (ring.s_from + ring.s_to)};
    return projected_axis(renderer, place).front().pixel.value();
  }

  SeenArmConfig options;
  Scene scene;
  View view;
  Image<std::uint8_t> picture;
};

TEST(Markers, AreFoundInOrderToAFewTenthsOfAPixel) {
  const BandedPicture seen(even_bands(0.09));
  const MarkerObservations found = seen.found();
  ASSERT_EQ(found.markers.size(), seen.scene.arm.markers.size());
  EXPECT_TRUE(found.notes.empty());
  for (std::size_t i = 0; i < found.markers.size(); ++i) {
    EXPECT_TRUE(found.markers[i].is_band);
    EXPECT_FALSE(found.markers[i].may_be_merged);
    EXPECT_LT((found.markers[i].pixel - seen.middle(i)).norm(), 0.4) << i;
    EXPECT_GT(found.markers[i].color.x(), 2 * found.markers[i].color.y());
  }
}

TEST(Markers, AMissingOneIsNotedWhereItIsMissing) {
  std::vector<MarkerRing> bands = even_bands(0.09);
  bands.erase(bands.begin() + 3);
  const MarkerObservations found = BandedPicture(bands).found();
  ASSERT_EQ(found.markers.size(), bands.size());
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_THAT(found.notes.front(), HasSubstr("between markers 3 and 4"));
}

TEST(Markers, TwoThatRunTogetherAreOneThatIsMarked) {
  std::vector<MarkerRing> bands = even_bands(0.09);
  bands.insert(bands.begin() + 5, {bands[4].s_to, bands[4].s_to + 0.024, red});
  const MarkerObservations found = BandedPicture(bands).found();
  ASSERT_EQ(found.markers.size(), bands.size() - 1);
  for (std::size_t i = 0; i < found.markers.size(); ++i)
    EXPECT_EQ(found.markers[i].may_be_merged, i == 4) << i;
}

TEST(Markers, TwoThatRunTogetherAmongThreeAreMarked) {
  for (const double gap : {0.0, 0.003}) {
    std::vector<MarkerRing> bands = even_bands(0.25);
    bands.resize(3);
    const double next = bands[1].s_to + gap;
    bands.insert(bands.begin() + 2, {next, next + 0.024, red});
    const MarkerObservations found = BandedPicture(bands).found();
    ASSERT_EQ(found.markers.size(), 3U);
    for (std::size_t i = 0; i < found.markers.size(); ++i)
      EXPECT_EQ(found.markers[i].may_be_merged, i == 1) << i << ' ' << gap;
  }
}

TEST(Markers, TwoOfOtherColoursThatTouchAreNotMixed) {
  std::vector<MarkerRing> bands = even_bands(0.18);
  bands[2].albedo = green;
  const MarkerObservations found = BandedPicture(bands).found();
  ASSERT_EQ(found.markers.size(), bands.size());
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const Eigen::Vector3d& color = found.markers[i].color;
    EXPECT_EQ(color.y() > color.x(), i == 2) << color.transpose();
  }
}

// Paints a disc of `radius` px around a point of the picture.
void paint(Image<std::uint8_t>& picture, const Eigen::Vector2d& at, double radius) {
  for (int v = 0; v < picture.height(); ++v)
    for (int u = 0; u < picture.width(); ++u)
      if (std::hypot(u - at.x(), v - at.y()) < radius) picture.at(u, v, 0) = 200;
}

TEST(Markers, SpeckOnTheArmIsNoBand) {
  BandedPicture seen(even_bands(0.18));
  // Between the second and the third band; half as wide as the arm.
  paint(seen.picture, 0.5 * (seen.middle(1) + seen.middle(2)), 4);
  const MarkerObservations found = seen.found();
  std::size_t bands = 0;
  for (const MarkerObservation& marker : found.markers) bands += marker.is_band ? 1 : 0;
  EXPECT_EQ(bands, seen.scene.arm.markers.size());
}

// A straight, slanting arm 24 px thick with red discs on it, blurred by the pixel alone.
struct SpottedPicture {
  static constexpr double half_width = 12;

  explicit SpottedPicture(const std::vector<Eigen::Vector3d>& discs, TestRandom& random)
      : picture(320, 400, 3) {
    const Eigen::Vector2d along = Eigen::Vector2d(-0.05, -1).normalized(), normal(-along.y(), along.x());
    for (const Eigen::Vector3d& disc : discs) centers.emplace_back(base + disc[0] * along + disc[1] * normal);
    for (int v = 0; v < picture.height(); ++v) {
      for (int u = 0; u < picture.width(); ++u) {
        const Eigen::Vector2d to = Eigen::Vector2d(u, v) - base;
        const double arm =
            share(std::abs(to.dot(normal)) - half_width) * share(std::abs(to.dot(along) - 150) - 150);
        double disc = 0;
        for (std::size_t i = 0; i < discs.size(); ++i)
          disc = std::max(disc, share((Eigen::Vector2d(u, v) - centers[i]).norm() - discs[i][2]));
        for (int c = 0; c < 3; ++c) {
          const double skin = 25 + disc * (c == 0 ? 165 : 5), light = 220 + arm * (skin - 220);
          picture.at(u, v, c) = static_cast<std::uint8_t>(
              std::lround(std::clamp(light + 2 * normal_number(random), 0.0, 255.0)));
        }
      }
    }
  }
  [[nodiscard]] MarkerObservations found() const {
    ArmFinder finder;
    const ArmObservation& arm = finder.find(gray_picture(picture));
    EXPECT_TRUE(arm.is_found()) << arm.reason;
    return find_markers(picture, arm);
  }

  Eigen::Vector2d base = {168, 350};
  std::vector<Eigen::Vector2d> centers;
  Image<std::uint8_t> picture;
};

TEST(Markers, SpotsAreFoundWhereverOnTheSkinTheyLie) {
  std::vector<double> misses;
  double over_sigma = 0;
  for_random_cases(20, [&](TestRandom& random) {
    std::vector<Eigen::Vector3d> discs;  // Along, aside, radius.
    for (int i = 0; i < 4; ++i) {
      const double radius = random.uniform(2.5, 6.5), aside = 11 - radius;
      discs.emplace_back(40 + 70 * i + random.uniform(-15, 15), random.uniform(-aside, aside), radius);
    }
    const SpottedPicture seen(discs, random);
    const MarkerObservations found = seen.found();
    ASSERT_EQ(found.markers.size(), discs.size());
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const MarkerObservation& spot = found.markers[i];
      const Eigen::Vector2d miss = spot.pixel - seen.centers[i];
      EXPECT_FALSE(spot.is_band) << i;
      EXPECT_LT(miss.norm(), 0.3) << i << ": aside " << discs[i][1] << ", radius " << discs[i][2];
      EXPECT_NEAR(spot.aside, discs[i][1], 0.3) << i;
      EXPECT_NEAR(spot.length, 2 * discs[i][2], 1.5) << i;
      misses.push_back(miss.norm());
      over_sigma += std::pow(miss.y() / spot.sigma, 2);
    }
  });
  EXPECT_LT(root_mean_square(misses), 0.1);
  const double over = std::sqrt(over_sigma / static_cast<double>(misses.size()));
  EXPECT_LT(over, 2);
  EXPECT_GT(over, 0.1);
}

TEST(Markers, TwoSpotsSideBySideAreTwo) {
  for_random_cases(10, [](TestRandom& random) {
    const double radius = random.uniform(2.5, 4), along = random.uniform(100, 110);
    const SpottedPicture seen({{along, -6, radius}, {along + 0.5, 6, radius}, {200, 0, radius}}, random);
    const MarkerObservations found = seen.found();
    ASSERT_EQ(found.markers.size(), 3U);
    for (const Eigen::Vector2d& center : seen.centers) {
      double nearest = 1e9;
      for (const MarkerObservation& spot : found.markers)
        nearest = std::min(nearest, (spot.pixel - center).norm());
      EXPECT_LT(nearest, 0.2);
    }
  });
}

// Arms with random bends: turned towards the camera, crossing themselves, with bands that are partly hidden.
TEST(Markers, BandsAreAsFarOffAsTheirSigmaSays) {
  std::size_t count = 0, beyond = 0, far_off = 0, spots = 0;
  for_random_cases(20, [&](TestRandom& random) {
    SeenArmConfig options;
    options.bands = options.color = true;
    const SeenArm seen = random_seen_arm(random, options);
    ArmFinder finder;
    ArmObservation arm = finder.find(gray_picture(seen.picture));
    if (!arm.is_found()) return;
    to_backbone_image(seen.view.lens, arm.axis);
    Renderer renderer;
    renderer.prepare(seen.scene, seen.view);
    const std::vector<MarkerView> views = marker_views(renderer);
    for (const MarkerObservation& marker : find_markers(seen.picture, arm).markers) {
      if (!marker.is_band) {
        ++spots;
        continue;
      }
      double miss = 1e9;
      for (const MarkerView& view : views)
        if (view.center.pixel && view.area > 0)
          miss = std::min(miss, (*view.center.pixel - marker.pixel).norm());
      ++count, beyond += miss > 4 * marker.sigma ? 1 : 0, far_off += marker.sigma > 1 ? 1 : 0;
    }
  });
  EXPECT_GT(count, 100U / one_case_of);
  EXPECT_LE(beyond, 1 + count / 100);
  EXPECT_LE(far_off, 1 + count / 20);
  EXPECT_LE(spots, 1 + count / 50);
}

TEST(Markers, WhatIsBesideTheArmIsNone) {
  BandedPicture seen(even_bands(0.18));
  for (std::size_t i = 0; i < 2; ++i) paint(seen.picture, seen.middle(i) + Eigen::Vector2d(45, 5), 6);
  const MarkerObservations found = seen.found();
  EXPECT_EQ(found.markers.size(), seen.scene.arm.markers.size());
}

TEST(Markers, APlainArmHasNone) { EXPECT_TRUE(BandedPicture({}).found().markers.empty()); }

// The axis ends on the silhouette's border, half-way between arm and background.
TEST(Markers, TheGroundBehindAnEndIsNoSpotOfAnotherColour) {
  Image<std::uint8_t> picture(320, 240, 1, 220);
  for (int v = 40; v < 200; ++v)
    for (int u = 150; u < 166; ++u) picture.at(u, v) = 20;
  ArmFinder finder;
  const ArmObservation& arm = finder.find(picture);
  ASSERT_TRUE(arm.is_found()) << arm.reason;
  EXPECT_THAT(find_markers(picture, arm).notes, testing::IsEmpty());
  // A spot on the arm is reported.
  for (int v = 100; v < 103; ++v)
    for (int u = 157; u < 159; ++u) picture.at(u, v) = 120;
  EXPECT_THAT(find_markers(picture, finder.find(picture)).notes,
              testing::ElementsAre(HasSubstr("1 spot of another colour")));
}

}  // namespace
}  // namespace flexura
