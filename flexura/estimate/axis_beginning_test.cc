#include "flexura/estimate/axis_beginning.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

namespace flexura {
namespace {

// Points on a circle, `spacing` px apart along it, from (100, 100) on towards `way` (rad); curvature in 1/px.
Observation arc(double spacing, double length, double curvature, double way = 0.3) {
  Observation seen;
  for (double s = 0; s <= length; s += spacing) {
    const double turn = curvature * s, chord = turn == 0 ? s : s * std::sin(turn / 2) / (turn / 2);
    seen.points.push_back(
        {.pixel = Eigen::Vector2d(100, 100) +
                  chord * Eigen::Vector2d(std::cos(way + turn / 2), std::sin(way + turn / 2)),
         .sigma = 0.02});
  }
  return seen;
}

Eigen::Vector2d beside(double along, double across, double way = 0.3) {
  return Eigen::Vector2d(100, 100) + along * Eigen::Vector2d(std::cos(way), std::sin(way)) +
         across * Eigen::Vector2d(-std::sin(way), std::cos(way));
}

// For any size of the picture, and hence any distance between its points.
TEST(AxisBeginning, TellsHowFarAPixelIsAside) {
  for (const double spacing : {1.0, 3.0, 8.0, 24.0}) {
    const Observation seen = arc(spacing, 100 * spacing, 0.2 / (100 * spacing));
    const auto on = aside_of_beginning(seen, beside(-2, 0)), off = aside_of_beginning(seen, beside(-2, 1.5));
    ASSERT_TRUE(on && off) << spacing;
    EXPECT_LT(on->distance, 0.01) << spacing;
    EXPECT_NEAR(off->distance, 1.5, 0.02) << spacing;
    EXPECT_LT(off->sigma, 0.1) << spacing;
  }
}

TEST(AxisBeginning, SaysNothingOfWhatIsShortOrCurledOrElsewhere) {
  EXPECT_FALSE(aside_of_beginning({}, beside(0, 1)));
  EXPECT_FALSE(aside_of_beginning(arc(1, 35, 0), beside(0, 1))) << "35 px";
  EXPECT_FALSE(aside_of_beginning(arc(8, 48, 0), beside(0, 1))) << "seven points";
  EXPECT_TRUE(aside_of_beginning(arc(8, 56, 0), beside(0, 1)));
  EXPECT_FALSE(aside_of_beginning(arc(2, 200, 0.02), beside(0, 1))) << "0.8 rad in 40 px";
  EXPECT_TRUE(aside_of_beginning(arc(2, 200, 0), beside(-14, 1)));
  EXPECT_FALSE(aside_of_beginning(arc(2, 200, 0), beside(-16, 1)));
  EXPECT_TRUE(aside_of_beginning(arc(2, 200, 0), beside(4, 1)));
  EXPECT_FALSE(aside_of_beginning(arc(2, 200, 0), beside(6, 1)));
}

// A kink, which is no parabola, is reported as uncertain.
TEST(AxisBeginning, CountsWhatIsNoParabola) {
  Observation kinked = arc(2, 100, 0);
  for (std::size_t i = 10; i < kinked.points.size(); ++i)
    kinked.points[i].pixel +=
        0.3 * (static_cast<double>(i) - 10) * Eigen::Vector2d(-std::sin(0.3), std::cos(0.3));
  const auto found = aside_of_beginning(kinked, beside(-2, 0)),
             plain = aside_of_beginning(arc(2, 100, 0), beside(-2, 0));
  ASSERT_TRUE(found && plain);
  EXPECT_GT(found->sigma, 5 * plain->sigma);
}

}  // namespace
}  // namespace flexura
