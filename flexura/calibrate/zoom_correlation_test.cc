// When the largest correlation is at the true ratio (docs/calibration-paper.md, "Zoom by correlation").
#include "flexura/calibrate/zoom_correlation.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr int zoomed_width = 160, zoomed_height = 120;

// A dark figure on a bright background; `distance` of a pixel from its border, px, is positive outside.
template <class Distance>
Image<std::uint8_t> picture_of(const Distance& distance, TestRandom& random) {
  Image<std::uint8_t> picture(zoomed_width, zoomed_height);
  for (int v = 0; v < zoomed_height; ++v) {
    for (int u = 0; u < zoomed_width; ++u) {
      const double dark = std::clamp(0.5 - distance(Eigen::Vector2d(u, v)), 0.0, 1.0);
      picture.at(u, v) =
          static_cast<std::uint8_t>(std::clamp(215.5 - 190 * dark + normal_number(random), 0.0, 255.0));
    }
  }
  return picture;
}

// A star-shaped figure: all of its border is visible from its middle.
Image<std::uint8_t> star(double size, double depth, const Eigen::Vector2d& middle, TestRandom& random) {
  return picture_of(
      [&](const Eigen::Vector2d& pixel) {
        const Eigen::Vector2d way = pixel - middle;
        const double angle = std::atan2(way.y(), way.x());
        return way.norm() - size * (1 + depth * (std::cos(2 * angle) + 0.7 * std::cos(3 * angle)));
      },
      random);
}

TEST(ZoomCorrelation, FindsEveryRatioBetweenHalfAndTwoAndBeyondTheEndThatIsNearer) {
  for_random_cases(12, [](TestRandom& random) {
    const double size = random.uniform(15, 20), depth = random.uniform(0, 0.2);
    const double side = random.integer(0, 1) == 1 ? 1 : -1;
    const auto ideal = star(size, depth, {80, 60}, random);
    const auto seen_by = [&](double ratio) {
      const Eigen::Vector2d middle(random.uniform(76, 84), random.uniform(58, 62));
      return correlate_zoom(star(ratio * size, depth, middle, random), ideal);
    };
    const double inside = std::exp(side * random.uniform(0, 0.66));  // The range ends at ln 2 = 0.69.
    const ZoomCorrelation found = seen_by(inside);
    ASSERT_EQ(found.reason, "");
    EXPECT_NEAR(found.ratio / inside, 1, 0.015);
    EXPECT_GT(found.peak, 0.95);
    const double beyond = std::exp(side * random.uniform(0.8, 0.95));
    EXPECT_NEAR(side * std::log(seen_by(beyond).ratio), std::numbers::ln2, 0.035);
  });
}

// At some roll angle an arc-shaped arm overlaps itself by half; the correlation there is 1/2.
TEST(ZoomCorrelation, RefusesAnArcThatIsRolledOffHalfOfItself) {
  for_random_cases(24, [](TestRandom& random) {
    const double half = random.uniform(0.8, 1.2), radius = random.uniform(34, 40),
                 width = random.uniform(6, 9);
    const double centroid = radius * std::sin(half) / half;  // From the circle's centre.
    const auto arc = [&](double roll) {
      const Eigen::Rotation2Dd back(-roll);
      return picture_of(
          [&](const Eigen::Vector2d& pixel) {
            const Eigen::Vector2d p = back * (pixel - Eigen::Vector2d(80, 60)) + Eigen::Vector2d(centroid, 0);
            const double angle = std::clamp(std::atan2(p.y(), p.x()), -half, half);
            return (p - radius * Eigen::Vector2d(std::cos(angle), std::sin(angle))).norm() - 0.5 * width;
          },
          random);
    };
    // Share of the figure in the picture, and its overlap with itself after a roll. Pieces move across
    // themselves by roll centroid sin(angle).
    const double share = (2 * half * radius * width + 0.25 * std::numbers::pi * width * width) /
                         (zoomed_width * zoomed_height);
    const double lost = centroid * (1 - std::cos(half)) / (half * width), edge = 0.5 * (1 - share) / lost;
    const auto ideal = arc(0);
    const double side = random.integer(0, 1) == 1 ? 1 : -1;
    for (const double part : {random.uniform(0.1, 0.5), random.uniform(0.5, 0.85)}) {
      const ZoomCorrelation found = correlate_zoom(arc(side * part * edge), ideal);
      EXPECT_EQ(found.reason, "") << part << " of " << edge << " rad";
      EXPECT_NEAR(found.peak, (1 - part * edge * lost - share) / (1 - share), 0.06);
      EXPECT_NEAR(found.ratio, 1, part < 0.5 ? 0.05 : 0.2);  // The nearer to the edge, the flatter the peak.
    }
    const ZoomCorrelation refused = correlate_zoom(arc(side * random.uniform(1.25, 1.6) * edge), ideal);
    EXPECT_NE(refused.reason, "") << refused.peak;
  });
}

TEST(ZoomCorrelation, RefusesPicturesOfNothingAndOfTwoSizes) {
  Image<std::uint8_t> blank(zoomed_width, zoomed_height);
  std::ranges::fill(blank.values(), std::uint8_t{200});
  EXPECT_NE(correlate_zoom(blank, blank).reason, "");
  EXPECT_THROW((void)correlate_zoom(Image<std::uint8_t>(10, 10), blank), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
