// Arms in front of anything: found by a region, a picture of the background, a colour, or a mask.
#include "flexura/vision/arm_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/drawn_scenes.h"

namespace flexura {
namespace {

using testing::HasSubstr;

constexpr double arc_u = 380, arc_v = 240, arc_radius = 150;

const ArmObservation& find_in(ArmFinder& finder, const ArmScene& scene, const Image<std::uint8_t>& picture,
                              ArmFinderConfig config = {}) {
  config.scene = std::make_shared<const ArmScene>(scene);
  finder = ArmFinder(config);
  Photograph photograph;
  photograph.bytes = picture;
  return finder.find(photograph);
}

// Returns the rms distance of the axis from the drawn arc, px.
double arc_error(const ArmObservation& found) {
  EXPECT_TRUE(found.is_found()) << found.reason;
  double squares = 0, count = 0;
  for (const AxisSample& sample : found.axis) {
    if (!sample.is_seen) continue;
    const double off = std::hypot(sample.pixel.x() - arc_u, sample.pixel.y() - arc_v) - arc_radius;
    squares += off * off, ++count;
  }
  EXPECT_GT(count, 0.8 * arc_radius);
  return std::sqrt(squares / std::max(count, 1.0));
}

// Clutter: texture, boards and rods of many brightnesses.
DrawnScene clutter(int channels) {
  DrawnScene scene(640, 480, channels);
  const DrawnTexture texture(11, 40);
  scene.ground([&](int u, int v, int c) { return 60 + (c == 2 ? 90 : 130) * texture(u + 30 * c, v); });
  scene.bar(40, 20, 200, 140, 30)
      .bar(60, 300, 180, 460, 220)
      .bar(420, 0, 436, 480, 25)
      .bar(480, 100, 640, 130, 240);
  return scene;
}

double arm_gray(int u, int v, int) { return 35 + 10 * std::cos(0.05 * (u + v)); }

TEST(ArmScene, FindsAnArmInARegion) {
  // The arm is before a sheet; around it there is clutter.
  DrawnScene scene = clutter(1);
  scene.bar(195, 60, 400, 425, 235).arc(arc_u, arc_v, arc_radius, 18, arm_gray);
  const Image<std::uint8_t> picture = scene.photograph(1, 1);
  ArmFinder finder;
  ArmScene rectangle{.region = {{200, 66}, {395, 66}, {395, 420}, {200, 420}}};
  const ArmObservation& found = find_in(finder, rectangle, picture);
  EXPECT_LT(arc_error(found), 0.05);
  EXPECT_NEAR(found.ends[0].pixel.x(), arc_u, 1.5);
  // A polygon that leaves out a corner of the sheet where there is something else.
  scene.bar(200, 66, 235, 120, 20).bar(200, 360, 235, 420, 20);
  ArmScene polygon{.region = {{245, 66}, {395, 66}, {395, 420}, {245, 420}, {202, 330}, {202, 150}}};
  EXPECT_LT(arc_error(find_in(finder, polygon, scene.photograph(1, 2))), 0.05);
  // The region cuts the arm.
  ArmScene lower{.region = {{200, 240}, {395, 240}, {395, 420}, {200, 420}}};
  const ArmObservation& half = find_in(finder, lower, picture);
  ASSERT_TRUE(half.is_found()) << half.reason;
  EXPECT_TRUE(half.ends[0].kind == AxisEndKind::border || half.ends[1].kind == AxisEndKind::border);
  for (const AxisSample& sample : half.axis) EXPECT_GE(sample.pixel.y(), 238);
  EXPECT_THAT(find_in(finder, {.region = {{700, 0}, {800, 0}, {800, 100}}}, picture).reason,
              HasSubstr("the region has fewer than 8 rows or columns in the picture"));
}

TEST(ArmScene, FindsAnArmBeforeAKnownBackground) {
  ArmFinder finder;
  struct Light {
    int channels;
    double gain, offset;
  };
  for (const auto& [channels, gain, offset] : {Light{1, 1, 0}, {1, 0.85, 0}, {3, 1.1, 8}}) {
    const DrawnScene empty = clutter(channels);
    DrawnScene with_arm = empty;
    with_arm.arc(arc_u, arc_v, arc_radius, 18, arm_gray);
    const Image<std::uint8_t> picture = with_arm.photograph(1.5, 3);
    Image<std::uint8_t> background = empty.photograph(1.5, 4);
    for (std::uint8_t& value : background.values())
      value = static_cast<std::uint8_t>(std::clamp(std::lround((value - offset) / gain), 0L, 255L));
    const ArmObservation& found = find_in(finder, {.background = background}, picture);
    const double error = arc_error(found);
    std::printf("%d channels, gain %.2f: rms error %.3f px, covered %.2f, contrast %.0f\n", channels, gain,
                error, found.covered, found.contrast);
    EXPECT_LT(error, 0.05);
    if (gain != 1) continue;
    EXPECT_FALSE(find_in(finder, {.background = background}, empty.photograph(1.5, 6)).is_found());
  }
  const Image<std::uint8_t> small(320, 240);
  EXPECT_THAT(find_in(finder, {.background = small}, clutter(1).photograph(1, 1)).reason,
              HasSubstr("the picture of the background has 320 x 240 px, but the picture has 640 x 480 px"));
  // Another view altogether.
  TestRandom random(1);
  Image<std::uint8_t> other(640, 480);
  for (std::uint8_t& value : other.values()) value = static_cast<std::uint8_t>(random.integer(3, 250));
  EXPECT_THAT(find_in(finder, {.background = other}, clutter(1).photograph(1, 1)).reason,
              HasSubstr("has the camera moved?"));
}

TEST(ArmScene, FindsAnArmByItsColour) {
  ArmFinder finder;
  DrawnScene scene = clutter(3);
  // A red arm, shaded across.
  const auto red = [](int u, int v, int c) {
    const double shade = 1 - 0.03 * std::abs(std::hypot(u - arc_u, v - arc_v) - arc_radius);
    return shade * (c == 0 ? 190.0 : 40.0);
  };
  scene.arc(arc_u, arc_v, arc_radius, 18, red);
  const Image<std::uint8_t> picture = scene.photograph(1.5, 5);
  const ArmObservation& found = find_in(finder, {.color = Eigen::Vector3d(175, 37, 37)}, picture);
  const double error = arc_error(found);
  std::printf("by colour: rms error %.3f px, covered %.2f\n", error, found.covered);
  EXPECT_LT(error, 0.3);
  EXPECT_FALSE(find_in(finder, {.color = Eigen::Vector3d(20, 200, 30)}, picture).is_found());
  EXPECT_THAT(find_in(finder, {.color = Eigen::Vector3d(175, 37, 37)}, clutter(1).photograph(1, 1)).reason,
              HasSubstr("the arm's colour is given, but the picture is gray"));
}

TEST(ArmScene, FindsAnArmByAMask) {
  ArmFinder finder;
  DrawnScene scene = clutter(1), drawn(640, 480);
  scene.arc(arc_u, arc_v, arc_radius, 18, arm_gray);
  drawn.ground([](int, int, int) { return 0; }).arc(arc_u, arc_v, arc_radius, 18, 255);
  const Image<std::uint8_t> picture = scene.photograph(1.5, 5);
  const double error = arc_error(find_in(finder, {.mask = drawn.photograph(0, 1)}, picture));
  std::printf("by mask: rms error %.3f px\n", error);
  EXPECT_LT(error, 0.3);
  // All cues must agree.
  const ArmObservation& none =
      find_in(finder, {.background = picture, .mask = drawn.photograph(0, 1)}, picture);
  EXPECT_THAT(none.reason, HasSubstr("no pixel belongs to the arm"));
}

}  // namespace
}  // namespace flexura
