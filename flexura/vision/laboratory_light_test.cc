// Pictures of laboratories whose light, frames or objects mislead a threshold of the whole picture: the arm
// is found, or the true reason is given.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>

#include "flexura/vision/arm_finder.h"
#include "tests/support/drawn_scenes.h"

namespace flexura {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

// Checks that the axis is the arc drawn by DrawnScene::arc().
void expect_arc(const ArmObservation& found, double u0, double v0, double radius, double within) {
  ASSERT_TRUE(found.is_found()) << found.reason;
  double squares = 0, count = 0;
  for (const AxisSample& sample : found.axis) {
    if (!sample.is_seen) continue;
    const double off = std::hypot(sample.pixel.x() - u0, sample.pixel.y() - v0) - radius;
    squares += off * off, ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), within);
  EXPECT_GT(count, radius) << "of an arc " << 3.14 * radius << " px long";
}

// Checks that the axis is an upright bar at column u, from one row to another.
void expect_bar(const ArmObservation& found, double u, double top, double bottom) {
  ASSERT_TRUE(found.is_found()) << found.reason;
  for (const AxisSample& sample : found.axis)
    ASSERT_NEAR(sample.pixel.x(), u, sample.is_seen ? 0.3 : 1.0) << sample.pixel.transpose();
  EXPECT_NEAR(found.ends[0].pixel.y(), bottom, 1.5);
  EXPECT_NEAR(found.ends[1].pixel.y(), top, 1.5);
}

TEST(LaboratoryLight, ShowsAnArmBeforeUnevenGround) {
  const auto ramp = [](double first, double last, int size) {
    return [=](int, int v, int) { return first + (last - first) * v / (size - 1); };
  };
  ArmFinder finder;
  // The ground alone has two classes for Otsu's method.
  const auto falling =
      DrawnScene(1280, 720).ground(ramp(240, 180, 720)).arc(640, 360, 150, 24, 60).photograph(1, 1);
  expect_arc(finder.find(falling), 640, 360, 150, 0.05);
  const auto steep =
      DrawnScene(640, 480).ground(ramp(90, 250, 480)).arc(320, 240, 150, 16, 30).photograph(1, 2);
  expect_arc(finder.find(steep), 320, 240, 150, 0.1);
  const auto bright =
      DrawnScene(640, 480).ground(ramp(10, 120, 480)).arc(320, 240, 150, 16, 200).photograph(1, 3);
  expect_arc(finder.find(bright), 320, 240, 150, 0.1);
  const auto lamp = [](int u, int v, int) {
    return 60 + 190 * std::exp(-1e-5 * std::pow(std::hypot(u - 200, v - 200), 2));
  };
  const auto shaded = DrawnScene(640, 480).ground(lamp).arc(320, 240, 120, 14, 25).photograph(1, 4);
  expect_arc(finder.find(shaded), 320, 240, 120, 0.1);
}

TEST(LaboratoryLight, ShowsThinLines) {
  ArmFinder finder;
  const auto line = DrawnScene(640, 480).ground([](int, int, int) { return 0; }).bar(320, 50, 321, 423, 255);
  expect_bar(finder.find(line.photograph(0, 1)), 320, 49.5, 422.5);
  const auto dark = DrawnScene(640, 480).ground([](int, int, int) { return 255; }).bar(200, 30, 203, 400, 0);
  expect_bar(finder.find(dark.photograph(0, 1)), 201, 29.5, 399.5);
  const auto noisy =
      DrawnScene(640, 480).ground([](int, int, int) { return 120; }).bar(200, 30, 203, 400, 60);
  expect_bar(finder.find(noisy.photograph(2, 1)), 201, 29.5, 399.5);
}

TEST(LaboratoryLight, IsNamedTrulyWhereThereIsNoArm) {
  ArmFinder finder;
  const auto reason_of = [&](const Image<std::uint8_t>& picture) {
    const ArmObservation& found = finder.find(picture);
    EXPECT_FALSE(found.is_found());
    return found.reason;
  };
  const auto plain = [](double value) { return [=](int, int, int) { return value; }; };
  EXPECT_THAT(reason_of(DrawnScene(320, 240).ground(plain(0)).photograph(0, 1)), HasSubstr("black"));
  EXPECT_THAT(reason_of(DrawnScene(320, 240).ground(plain(255)).photograph(0, 1)), HasSubstr("saturated"));
  EXPECT_THAT(reason_of(DrawnScene(320, 240).ground(plain(130)).photograph(2, 1)), HasSubstr("blank"));
  // A hundred hot pixels.
  auto hot = DrawnScene(320, 240).ground(plain(0)).photograph(0, 1);
  for (int i = 0; i < 100; ++i) hot.at(3 * (i % 100), 2 * ((37 * i) % 110)) = 255;
  EXPECT_THAT(reason_of(hot), HasSubstr("no figure with at least 24 px"));
  // A ground that falls from one side to the other is not blank, and has no arm.
  const auto ramp =
      DrawnScene(320, 240).ground([](int u, int, int) { return 60 + 0.5 * u; }).photograph(1, 1);
  EXPECT_THAT(reason_of(ramp), Not(HasSubstr("blank")));
  // A disc: the methods that failed are named, and what to try.
  const auto disc = [](int u, int v) { return std::hypot(u - 160, v - 120) - 60; };
  const std::string reason =
      reason_of(DrawnScene(320, 240).ground(plain(220)).shape(disc, plain(40)).photograph(1, 1));
  for (const char* part : {"otsu", "two_mode", "by_block", "not a tube", "region"})
    EXPECT_THAT(reason, HasSubstr(part));
}

TEST(LaboratoryLight, ReachesInsideAFrame) {
  ArmFinder finder;
  const auto plain = [](double value) { return [=](int, int, int) { return value; }; };
  // Frames of all four sides and of two, whose brightness is not the ground's.
  for (const int frame : {1, 5, 20, 50}) {
    for (const bool is_whole : {true, false}) {
      for (const double ground : {30.0, 225.0}) {
        SCOPED_TRACE(testing::Message()
                     << frame << " px, ground " << ground << (is_whole ? "" : ", two sides"));
        DrawnScene scene(640, 480);
        scene.ground(plain(255 - ground))
            .bar(is_whole ? frame : 0, frame, is_whole ? 640 - frame : 640, 480 - frame, ground);
        scene.arc(320, 240, 150, 16, 255 - ground);
        expect_arc(finder.find(scene.photograph(1, 5)), 320, 240, 150, 0.05);
      }
    }
  }
  // The arm begins at the frame.
  DrawnScene scene(640, 480);
  scene.ground(plain(255)).bar(5, 5, 635, 475, 30).bar(300, 100, 320, 475, 200);
  const ArmObservation& found = finder.find(scene.photograph(1, 6));
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_EQ(found.ends[0].kind, AxisEndKind::border);
  EXPECT_NEAR(found.ends[0].pixel.y(), 473, 3);
  EXPECT_NEAR(found.ends[1].pixel.y(), 99.5, 1);
  EXPECT_NEAR(found.axis[found.axis.size() / 2].pixel.x(), 309.5, 0.05);
  EXPECT_THAT(found.notes, Contains(HasSubstr("frame")));
}

// The base chooses among figures.
TEST(ArmHints, ChooseTheFigureAtTheBase) {
  const auto plain = [](double value) { return [=](int, int, int) { return value; }; };
  const auto two = DrawnScene(640, 480)
                       .ground(plain(230))
                       .bar(90, 100, 110, 400, 40)
                       .bar(390, 150, 410, 400, 40)
                       .photograph(1, 1);
  ArmFinderConfig config;
  expect_bar(ArmFinder(config).find(two), 99.5, 99.5, 399.5);
  for (const auto& [base, u, top] : {std::tuple{Eigen::Vector2d(400, 400), 399.5, 149.5},
                                     {Eigen::Vector2d(100, 400), 99.5, 99.5},
                                     {Eigen::Vector2d(425, 415), 399.5, 149.5}}) {
    config.base = base;
    ArmFinder finder(config);
    const ArmObservation& found = finder.find(two);
    expect_bar(found, u, top, 399.5);
    EXPECT_FALSE(found.contradicts);
    EXPECT_THAT(found.notes,
                Contains(HasSubstr("1 other figure of similar size: the tube at the base was measured")));
  }
  // A base far from any figure: the answer says so.
  config.base = Eigen::Vector2d(250, 250);
  const ArmObservation lost = ArmFinder(config).find(two);
  EXPECT_TRUE(lost.contradicts);
  EXPECT_THAT(lost.notes, Contains(HasSubstr("the base is given at (250, 250)")));
}

TEST(ArmHints, TellAnArmFromAPlate) {
  const auto plain = [](double value) { return [=](int, int, int) { return value; }; };
  const auto plate = DrawnScene(640, 480)
                         .ground(plain(230))
                         .bar(100, 60, 170, 420, 40)
                         .bar(300, 120, 314, 420, 40)
                         .photograph(1, 1);
  ArmFinderConfig config;
  const ArmObservation unknown = ArmFinder(config).find(plate);
  ASSERT_TRUE(unknown.is_found());
  EXPECT_THAT(unknown.notes, Contains(HasSubstr("1 other figure")));
  config.base = Eigen::Vector2d(307, 420);
  expect_bar(ArmFinder(config).find(plate), 306.5, 119.5, 419.5);
  config.base.reset();
  config.width = {10, 20};
  expect_bar(ArmFinder(config).find(plate), 306.5, 119.5, 419.5);
  config.width = {4, 8};
  const ArmObservation wrong = ArmFinder(config).find(plate);
  EXPECT_TRUE(wrong.contradicts);
  EXPECT_THAT(wrong.notes, Contains(HasSubstr("but the arm should be 4 to 8 px wide")));
}

TEST(ArmHints, BeginTheArmAtItsBase) {
  const auto plain = [](double value) { return [=](int, int, int) { return value; }; };
  // The arm stands on a post of its own width and brightness.
  const auto post = DrawnScene(640, 480).ground(plain(230)).bar(300, 60, 320, 480, 40).photograph(1, 1);
  ArmFinderConfig config;
  config.base = Eigen::Vector2d(310, 350);
  config.cuts_at_base = true;
  const ArmObservation on_post = ArmFinder(config).find(post);
  expect_bar(on_post, 309.5, 59.5, 350);
  EXPECT_THAT(on_post.notes, Contains(HasSubstr("px beyond the given base")));
  for (const Eigen::Vector2d& place : on_post.places) EXPECT_LT(place.y(), 353);
  // On a block of its brightness.
  for (const bool has_base : {false, true}) {
    config.base.reset();
    if (has_base) config.base = Eigen::Vector2d(310, 350);
    // A long block could be a thick arm itself: only the base shows that it is not.
    const double half = has_base ? 130 : 90;
    const auto block = DrawnScene(640, 480)
                           .ground(plain(230))
                           .bar(300, 60, 320, 350, 40)
                           .bar(310 - half, 350, 310 + half, 450, 40)
                           .photograph(1, 1);
    const ArmObservation on_block = ArmFinder(config).find(block);
    ASSERT_TRUE(on_block.is_found()) << on_block.reason;
    EXPECT_NEAR(on_block.ends[1].pixel.y(), 59.5, 1);
    EXPECT_NEAR(on_block.ends[0].pixel.y(), 345, 12);
    for (const AxisSample& sample : on_block.axis)
      EXPECT_NEAR(sample.pixel.x(), 309.5, sample.is_seen ? 0.1 : 1.0);
    EXPECT_THAT(on_block.notes, Contains(HasSubstr("wider figure")));
  }
}

}  // namespace
}  // namespace flexura
