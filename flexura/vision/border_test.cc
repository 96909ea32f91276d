#include "flexura/vision/border.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "flexura/vision/conic.h"
#include "flexura/vision/etalon_finder.h"

namespace flexura {
namespace {

// A blurred figure given by its signed distance (positive outside), with noise of one level.
template <typename Distance>
Image<std::uint8_t> blurred_figure(double blur, double figure, double ground, unsigned seed,
                                   const Distance& distance) {
  Image<std::uint8_t> picture(200, 180);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1);
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      const double inside = 0.5 * std::erfc(distance(u, v) / (blur * std::numbers::sqrt2));
      picture.at(u, v) =
          static_cast<std::uint8_t>(std::lround(ground + inside * (figure - ground) + noise(random)));
    }
  }
  return picture;
}

TEST(LargestFigure, HasItsBorderWhereItIsInOrderHoweverBlurred) {
  unsigned seed = 11;
  for (const double blur : {0.5, 0.6, 0.7, 0.9, 1.2, 1.6, 2.2, 3.0}) {
    for (const bool is_dark : {true, false}) {
      const double radius = 60.25;
      const auto picture =
          blurred_figure(blur, is_dark ? 40 : 210, is_dark ? 210 : 40, ++seed,
                         [&](int u, int v) { return std::hypot(u - 100.3, v - 88.6) - radius; });
      const FigureBorder found = largest_figure(picture);
      std::vector<Eigen::Vector2d> points;
      points.reserve(found.points.size());
      for (const BorderPoint& point : found.points) points.push_back(point.pixel);
      const auto circle = fit_circle(points);
      ASSERT_TRUE(circle) << blur;
      EXPECT_NEAR(circle->radius, radius, blur < 1 ? 0.006 : 0.015 * blur) << blur << ", seed " << seed;
      EXPECT_LT(circle->rms, 0.025 + 0.02 * blur) << blur;
      EXPECT_NEAR(found.blur, blur, 0.03 * blur) << is_dark;
      EXPECT_GT(points.size(), 300U) << blur;
      // In order: successive points are neighbours, or farther apart where the blur removes some.
      const double nearby = blur < 1 ? 2.5 : 4;
      for (std::size_t i = 1; i < points.size(); ++i)
        EXPECT_LT((points[i] - points[i - 1]).norm(), nearby) << i << ", blur " << blur;
    }
  }
}

TEST(EtalonSides, AreFoundWhereTheyAreHoweverBlurred) {
  unsigned seed = 31;
  for (const double blur : {0.5, 0.7, 1.0, 1.5, 2.2}) {
    const auto picture = blurred_figure(blur, 50, 220, ++seed, [](int u, int v) {
      return std::max(std::abs(u - 0.02 * (v - 90) - 100.3) - 40.4, std::abs(v - 90.2) - 70);
    });
    const EtalonObservation seen = find_etalon(picture, picture);
    ASSERT_EQ(seen.reason, "");
    const double at = 0.02 * (seen.middle_row - 90) + 100.3;
    EXPECT_NEAR(seen.left.at, at - 40.4, blur < 1.2 ? 0.012 : 0.04) << blur << ", seed " << seed;
    EXPECT_NEAR(seen.right.at, at + 40.4, blur < 1.2 ? 0.012 : 0.04) << blur;
    EXPECT_NEAR(seen.left.slope, 0.02, 5e-4) << blur;
  }
}

}  // namespace
}  // namespace flexura
