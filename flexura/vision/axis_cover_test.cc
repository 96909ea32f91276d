#include "flexura/vision/axis_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// A winding tube of changing width, as samples one or two pixels apart.
std::vector<AxisSample> winding_tube(TestRandom& random) {
  std::vector<AxisSample> axis;
  Eigen::Vector2d pixel = random.vector<2>(-20, 200);
  double heading = random.uniform(-3, 3), bend = random.uniform(-0.05, 0.05), width = random.uniform(3, 40);
  const double step = random.uniform(0.8, 2), taper = random.uniform(-0.02, 0.02);
  const int count = random.integer(1, 300);
  for (int i = 0; i < count; ++i) {
    axis.push_back({.pixel = pixel,
                    .normal = {-std::sin(heading), std::cos(heading)},
                    .width = width,
                    .sigma = 0.1,
                    .is_seen = true});
    pixel += step * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    heading += bend, width = std::max(2.0, width + taper);
  }
  return axis;
}

// Compares the grids with all samples.
TEST(AxisCover, IsThatOfAllSamples) {
  long on = 0, all = 0;
  AxisCover cover;
  for_random_cases(100, [&](TestRandom& random) {
    const std::vector<AxisSample> axis = winding_tube(random);
    cover.set(axis);
    for (int i = 0; i < 300; ++i) {
      const AxisSample& near =
          axis[static_cast<std::size_t>(random.integer(0, static_cast<int>(axis.size()) - 1))];
      const double sign = random.integer(0, 1) == 0 ? 0.5 : -0.5, close = random.uniform(0.2, 1.5);
      const Eigen::Vector2d place = near.pixel + sign * near.width * near.normal + random.vector<2>(-4, 4);
      const bool is_on = std::ranges::any_of(axis, [&](const AxisSample& sample) {
        const Eigen::Vector2d off = place - sample.pixel;
        const double across = std::abs(off.dot(sample.normal));
        return std::abs(across - 0.5 * sample.width) < close &&
               off.squaredNorm() < across * across + AxisCover::along * AxisCover::along;
      });
      EXPECT_EQ(cover.is_border(place, close), is_on);
      on += is_on ? 1 : 0, ++all;
    }
    EXPECT_FALSE(cover.is_border({1e9, -1e9}, 1));
    EXPECT_FALSE(cover.is_border({std::nan(""), 0}, 1));
    const AxisSample& one = axis[axis.size() / 2];
    EXPECT_TRUE(cover.has_chord(one.pixel, -one.normal));
    EXPECT_FALSE(cover.has_chord(one.pixel + 1e3 * one.normal, one.normal));
  });
  std::printf("%ld of %ld places on borders\n", on, all);
  EXPECT_GT(on, all / 20);
  EXPECT_LT(on, all - all / 20);
}

TEST(AxisCover, OfNothingHasNoBorders) {
  AxisCover cover;
  cover.set({});
  EXPECT_FALSE(cover.is_border({0, 0}, 1.5));
  EXPECT_FALSE(cover.has_chord({0, 0}, {1, 0}));
}

}  // namespace
}  // namespace flexura
