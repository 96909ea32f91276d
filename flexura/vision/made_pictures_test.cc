// Small made pictures of laboratories, each of one difficulty: the arm is where it was drawn, or the true
// reason is given.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/markers.h"
#include "tests/support/drawn_scenes.h"

namespace flexura {
namespace {

using testing::AnyOf, testing::Contains, testing::HasSubstr, testing::Not;

auto even(double value) {
  return [=](int, int, int) { return value; };
}

// Distance to a ring's left half, px.
auto left_arc(double u0, double v0, double radius, double width) {
  return [=](int u, int v) {
    return std::max(std::abs(std::hypot(u - u0, v - v0) - radius) - 0.5 * width, u - u0);
  };
}

// Distance to a straight piece, px.
auto piece(Eigen::Vector2d from, Eigen::Vector2d to, double width) {
  return [=](int u, int v) {
    const Eigen::Vector2d along = (to - from).normalized(), off = Eigen::Vector2d(u, v) - from;
    const double place = off.dot(along);
    return std::max({std::abs(off.x() * along.y() - off.y() * along.x()) - 0.5 * width, -place,
                     place - (to - from).norm()});
  };
}

// The arc that most pictures have: of radius 150 around the middle of 640 x 480 pixels.
constexpr double kU0 = 320, kV0 = 240, kRadius = 150;

struct MadePicture {
  std::string name;
  std::function<void(DrawnScene&)> paint;
  double width = 16, brightness = 40, noise = 1;  // of the arc, and of the picture
  double within = 0.1;                            // greatest rms of the axis, px
};

void PrintTo(const MadePicture& made, std::ostream* out) { *out << made.name; }

class ArcPicture : public testing::TestWithParam<MadePicture> {};

TEST_P(ArcPicture, ShowsTheArc) {
  const MadePicture& made = GetParam();
  DrawnScene scene(640, 480);
  made.paint(scene);
  const auto picture = scene.arc(kU0, kV0, kRadius, made.width, made.brightness).photograph(made.noise, 11);
  ArmFinder finder;
  const ArmObservation& found = finder.find(picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  double squares = 0, count = 0;
  for (const AxisSample& sample : found.axis) {
    if (!sample.is_seen) continue;
    const double off = std::hypot(sample.pixel.x() - kU0, sample.pixel.y() - kV0) - kRadius;
    squares += off * off, ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), made.within);
  // The whole arc, to its two ends.
  EXPECT_LT((found.ends[0].pixel - Eigen::Vector2d(kU0, kV0 + kRadius)).norm(), 3) << found.ends[0].pixel;
  EXPECT_LT((found.ends[1].pixel - Eigen::Vector2d(kU0, kV0 - kRadius)).norm(), 3) << found.ends[1].pixel;
}

std::vector<MadePicture> arc_pictures() {
  const auto ground = [](const auto& value) { return [=](DrawnScene& scene) { scene.ground(value); }; };
  const auto lamp = [](double u0, double v0, double reach) {
    return [=](int u, int v) { return std::exp(-std::pow(std::hypot(u - u0, v - v0) / reach, 2)); };
  };
  const DrawnTexture plaster(5, 60);
  return {
      {"FromLeftToRight", ground([](int u, int, int) { return 250 - 0.25 * u; })},
      {"FromCornerToCorner", ground([](int u, int v, int) { return 90 + 0.14 * (u + v); })},
      {"DarkTowardsTheCorners", ground([](int u, int v, int) {
         return 230 / (1 + 4e-6 * std::pow(std::hypot(u - 320, v - 240), 2));
       })},
      {"TwoLamps", ground([=](int u, int v, int) {
         return 110 + 110 * lamp(80, 80, 220)(u, v) + 110 * lamp(560, 400, 220)(u, v);
       })},
      {"AtTheEdgeOfATable", ground([](int, int v, int) { return v < 300 ? 230 : 170; })},
      {"BeforeStripes", ground([](int u, int, int) { return 200 + 12 * std::sin(u / 9.0); })},
      {"BeforePlaster", ground([=](int u, int v, int) { return 170 + 70 * plaster(u, v); })},
      {"InMuchNoise", ground(even(200)), 16, 60, 12, 0.2},
      {"BrightBeforeARamp", ground([](int u, int, int) { return 20 + 0.15 * u; }), 16, 210},
      {"OfTwelveGrayLevels", ground(even(128)), 16, 116, 1, 0.15},
      {"OfTwelveGrayLevelsAbove", ground(even(128)), 16, 140, 1, 0.15},
      {"OfThreePixels", ground(even(200)), 3, 40},
      {"OfTwoBrightPixels", ground(even(20)), 2, 220},
      {"AsThickAsAHand", ground(even(210)), 70, 50},
      {"Overexposed", ground(even(300)), 16, 90},
      {"Underexposed", ground(even(40)), 16, -20},
      {"WithItsShadow",
       [](DrawnScene& scene) {
         scene.ground(even(220)).shape(left_arc(kU0 + 14, kV0 + 30, kRadius, 20), even(180));
       }},
      {"WithAScrew",
       [](DrawnScene& scene) {
         scene.ground(even(220)).shape([](int u, int v) { return std::hypot(u - 330, v - 250) - 14; },
                                       even(30));
       }},
      {"InAWhiteFrame", [](DrawnScene& scene) { scene.ground(even(255)).bar(7, 7, 633, 473, 60); }, 16, 180},
      {"BesideABlackBar", [](DrawnScene& scene) { scene.ground(even(210)).bar(600, 0, 640, 480, 0); }},
      {"BelowABlackBar", [](DrawnScene& scene) { scene.ground(even(210)).bar(0, 0, 640, 40, 0); }},
      {"WithADate",
       [](DrawnScene& scene) {
         scene.ground(even(210));
         for (int i = 0; i < 8; ++i) scene.bar(500 + 14 * i, 450, 510 + 14 * i, 466, 20);
       }},
  };
}

INSTANTIATE_TEST_SUITE_P(Made, ArcPicture, testing::ValuesIn(arc_pictures()),
                         [](const auto& test) { return test.param.name; });

// Returns why there is no arm.
std::string reason_of(const DrawnScene& scene, double noise) {
  ArmFinder finder;
  const ArmObservation& found = finder.find(scene.photograph(noise, 12));
  EXPECT_FALSE(found.is_found());
  return found.reason;
}

TEST(MadePictures, HaveTheTrueReasonWhereThereIsNoArm) {
  const auto plain = [](double value) {
    DrawnScene scene(320, 240);
    scene.ground(even(value));
    return scene;
  };
  EXPECT_THAT(reason_of(plain(3), 1), HasSubstr("too dark"));
  EXPECT_THAT(reason_of(plain(300), 1), HasSubstr("saturated"));
  EXPECT_THAT(reason_of(plain(90), 6), HasSubstr("blank"));
  EXPECT_THAT(reason_of(plain(128).arc(160, 120, 80, 12, 120), 1), HasSubstr("too faint"));
  const auto triangle = [](int u, int v) {
    return std::max({v - 200.0, 40.0 - v, std::abs(u - 160) - 0.6 * (v - 40)});
  };
  EXPECT_THAT(reason_of(plain(220).shape(triangle, even(30)), 1), HasSubstr("not a tube"));
  const auto wall = DrawnScene(320, 240).ground([](int u, int, int) { return u < 130 ? 40 : 220; });
  EXPECT_THAT(reason_of(wall, 1), Not(AnyOf(HasSubstr("blank"), HasSubstr("black"), HasSubstr("saturated"))));
  const auto board =
      DrawnScene(320, 240).ground([](int u, int v, int) { return (u / 40 + v / 40) % 2 == 0 ? 30 : 220; });
  EXPECT_THAT(reason_of(board, 1),
              Not(AnyOf(HasSubstr("blank"), HasSubstr("black"), HasSubstr("saturated"))));
}

// An endoscope's picture is round: the reason proposes a region, which shows the arm.
TEST(MadePictures, ARoundPictureNeedsARegion) {
  DrawnScene scene(640, 480);
  scene.ground(even(0))
      .shape([](int u, int v) { return std::hypot(u - 320, v - 240) - 225; }, even(200))
      .arc(kU0, kV0, kRadius, 16, 40);
  EXPECT_THAT(reason_of(scene, 1), HasSubstr("region"));
  ArmScene round;
  for (int i = 0; i < 12; ++i)
    round.region.emplace_back(320 + 215 * std::cos(i * std::numbers::pi / 6),
                              240 + 215 * std::sin(i * std::numbers::pi / 6));
  ArmFinderConfig config;
  config.scene = std::make_shared<const ArmScene>(round);
  ArmFinder finder(config);
  const ArmObservation& found = finder.find(scene.photograph(1, 12));
  ASSERT_TRUE(found.is_found()) << found.reason;
  for (const AxisSample& sample : found.axis) {
    if (!sample.is_seen) continue;
    EXPECT_NEAR(std::hypot(sample.pixel.x() - kU0, sample.pixel.y() - kV0), kRadius, 0.3);
  }
}

// Returns the observation of an arm in the picture of a scene.
ArmObservation observed(const DrawnScene& scene, const ArmFinderConfig& config = {}) {
  ArmFinder finder(config);
  return finder.find(scene.photograph(1, 13));
}

void expect_upright(const ArmObservation& found, double u, double top, double bottom) {
  ASSERT_TRUE(found.is_found()) << found.reason;
  for (const AxisSample& sample : found.axis) ASSERT_NEAR(sample.pixel.x(), u, sample.is_seen ? 0.3 : 1.0);
  EXPECT_NEAR(found.ends[0].pixel.y(), bottom, 1.5);
  EXPECT_NEAR(found.ends[1].pixel.y(), top, 1.5);
}

TEST(MadePictures, TheBaseChoosesAmongArmsOfAnyBrightness) {
  // The arm in the middle is the shortest.
  DrawnScene three(640, 480);
  three.ground(even(225)).bar(100, 60, 116, 420, 40).bar(300, 200, 316, 420, 40).bar(500, 60, 516, 420, 40);
  ArmFinderConfig config;
  config.base = Eigen::Vector2d(308, 420);
  expect_upright(observed(three, config), 307.5, 199.5, 419.5);
  // The arm at the base is lighter than the other.
  DrawnScene light(640, 480);
  light.ground(even(225)).bar(100, 60, 116, 420, 30).bar(400, 60, 416, 420, 120);
  config.base = Eigen::Vector2d(408, 420);
  expect_upright(observed(light, config), 407.5, 59.5, 419.5);
  // Far from both.
  config.base = Eigen::Vector2d(258, 240);
  const ArmObservation between = observed(light, config);
  EXPECT_TRUE(between.contradicts);
  EXPECT_THAT(between.notes, Contains(HasSubstr("the base is given at (258, 240)")));
  // One arm comes from the picture's border, another lies free: the base is the free one's lower end.
  DrawnScene free(640, 480);
  free.ground(even(225)).bar(100, 0, 116, 400, 40).bar(400, 100, 416, 400, 40);
  config.base = Eigen::Vector2d(408, 400);
  expect_upright(observed(free, config), 407.5, 99.5, 399.5);
}

TEST(MadePictures, MountsAreNoPartOfTheArm) {
  // A round mount of the arm's brightness.
  DrawnScene disc(640, 480);
  disc.ground(even(225))
      .bar(300, 60, 320, 380, 40)
      .shape([](int u, int v) { return std::hypot(u - 309.5, v - 420) - 50; }, even(40));
  ArmFinderConfig config;
  config.base = Eigen::Vector2d(310, 372);
  const ArmObservation found = observed(disc, config);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_NEAR(found.ends[1].pixel.y(), 59.5, 1);
  EXPECT_NEAR(found.ends[0].pixel.y(), 372, 15);
  for (const AxisSample& sample : found.axis) EXPECT_NEAR(sample.pixel.x(), 309.5, 1.0);
  // A post of twice the arm's width.
  DrawnScene post(640, 480);
  post.ground(even(225)).bar(302, 60, 318, 300, 40).bar(290, 300, 330, 480, 40);
  config.base = Eigen::Vector2d(310, 300);
  config.cuts_at_base = true;
  const ArmObservation on_post = observed(post, config);
  ASSERT_TRUE(on_post.is_found()) << on_post.reason;
  EXPECT_NEAR(on_post.ends[1].pixel.y(), 59.5, 1);
  EXPECT_NEAR(on_post.ends[0].pixel.y(), 300, 15);
  for (const AxisSample& sample : on_post.axis) EXPECT_NEAR(sample.pixel.x(), 309.5, 1.0);
}

TEST(MadePictures, CrossedArmsAreNamed) {
  DrawnScene crossed(640, 480);
  crossed.ground(even(225))
      .shape(piece({150, 420}, {490, 60}, 14), even(40))
      .shape(piece({150, 60}, {490, 420}, 14), even(40));
  const ArmObservation found = observed(crossed);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_FALSE(found.is_whole());
  // What was measured is one of the two.
  for (const AxisSample& sample : found.axis) {
    const double rising =
        std::abs((sample.pixel.x() - 320) * 360 + (sample.pixel.y() - 240) * 340) / std::hypot(360, 340);
    const double falling =
        std::abs((sample.pixel.x() - 320) * 360 - (sample.pixel.y() - 240) * 340) / std::hypot(360, 340);
    EXPECT_LT(std::min(rising, falling), 1.0) << sample.pixel.transpose();
  }
}

TEST(MadePictures, SkinsHaveNoMarkersOfTheirOwn) {
  const auto wave = [](double place, double period) {
    return std::sin(2 * std::numbers::pi * place / period);
  };
  const std::vector<std::pair<std::string, std::function<double(int, int)>>> skins = {
      {"checks", [](int u, int v) { return (u / 5 + v / 5) % 2 == 0 ? 45.0 : 85.0; }},
      {"stripes", [=](int u, int v) { return 60 + 25 * wave(u + 2.0 * v, 10); }},
      {"knit", [=](int u, int v) { return 60 + 20 * wave(u, 6) + 20 * wave(v, 8); }},
      {"bellows", [=](int, int v) { return 60 + 25 * wave(v, 10 + 0.01 * v); }},
      {"threads", [=](int u, int v) { return 50 + (wave(u - 0.7 * v, 8) > 0 ? 40 : 0); }}};
  for (const auto& [name, skin] : skins) {
    SCOPED_TRACE(name);
    DrawnScene scene(320, 480);
    scene.ground(even(230)).shape(
        [](int u, int v) { return std::max(std::abs(u - 160) - 15.0, std::abs(v - 240) - 200.0); },
        [&](int u, int v, int) { return skin(u, v); });
    const auto picture = scene.photograph(1, 14);
    ArmFinder finder;
    const ArmObservation& arm = finder.find(picture);
    ASSERT_TRUE(arm.is_found()) << arm.reason;
    const MarkerObservations found = find_markers(picture, arm);
    EXPECT_EQ(found.markers.size(), 0U);
    EXPECT_THAT(found.notes, Contains(HasSubstr("has a texture")));
  }
}

}  // namespace
}  // namespace flexura
