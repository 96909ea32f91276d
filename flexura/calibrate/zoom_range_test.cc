// When the largest correlation is at the true ratio (docs/calibration-paper.md, "Zoom by correlation").
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "flexura/calibrate/zoom_correlation.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr int zoomed_width = 160, zoomed_height = 120;
const Eigen::Vector2d zoomed_middle(80, 60), beside_the_picture(-100, -100);

// The share of the picture that is within so many pixels.
double share_of(double area) { return area / (zoomed_width * zoomed_height); }

// A dark figure before a bright ground; `distance` is a pixel's from its border, px, positive outside.
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

// Of two figures that fill the shares `real` and `ideal` of the picture, when the share `covered` of the
// ideal one lies upon the real one.
double correlation_of(double covered, double real, double ideal) {
  return (covered - real) * std::sqrt(ideal / real / ((1 - real) * (1 - ideal)));
}

// A figure all of whose border is seen from its middle.
struct StarFigure {
  double size;  // Its radius in the mean, px.
  std::array<double, 2> depth, phase;

  explicit StarFigure(TestRandom& random)
      : size(random.uniform(15, 20)),
        depth{random.uniform(0, 0.2), random.uniform(0, 0.15)},
        phase{random.uniform(-3, 3), random.uniform(-3, 3)} {}
  [[nodiscard]] double area() const {
    return std::numbers::pi * size * size * (1 + 0.5 * (depth[0] * depth[0] + depth[1] * depth[1]));
  }
  [[nodiscard]] Image<std::uint8_t> picture(const Eigen::Vector2d& middle, TestRandom& random) const {
    const auto distance = [&](const Eigen::Vector2d& pixel) {
      const Eigen::Vector2d way = pixel - middle;
      const double angle = std::atan2(way.y(), way.x());
      return way.norm() - size * (1 + depth[0] * std::cos(2 * angle + phase[0]) +
                                  depth[1] * std::cos(3 * angle + phase[1]));
    };
    return picture_of(distance, random);
  }
};

TEST(ZoomRange, IsAllOfItForAFigureThatIsSeenFromItsMiddle) {
  for_random_cases(24, [](TestRandom& random) {
    const StarFigure ideal(random);
    const auto drawn = ideal.picture(zoomed_middle, random);
    const double side = random.integer(0, 1) == 1 ? 1 : -1;
    const auto enlarged = [&](double ratio) {
      StarFigure real = ideal;
      real.size *= ratio;
      return real;
    };
    const double inside = std::exp(side * random.uniform(0, 0.66));  // The range ends at ln 2 = 0.69.
    const ZoomCorrelation found = correlate_zoom(enlarged(inside).picture({78, 63}, random), drawn);
    ASSERT_EQ(found.reason, "");
    EXPECT_NEAR(found.ratio / inside, 1, 0.015);
    EXPECT_GT(found.peak, 0.95);
    // Beyond it the range's end is what comes nearest, and the smaller figure fills only a part of the
    // larger.
    const StarFigure real = enlarged(std::exp(side * random.uniform(0.8, 0.95)));
    const ZoomCorrelation end = correlate_zoom(real.picture({78, 63}, random), drawn);
    EXPECT_NEAR(side * std::log(end.ratio), std::numbers::ln2, 0.035);
    const double is = share_of(real.area()), should = end.ratio * end.ratio * share_of(ideal.area());
    EXPECT_NEAR(end.peak, correlation_of(std::min(1.0, is / should), is, should), 0.06);
  });
}

// An arm bent into an arc of `half` rad to both sides of +u.
struct ArcFigure {
  double half, radius, width;  // rad, px, px

  explicit ArcFigure(TestRandom& random)
      : half(random.uniform(0.8, 1.2)), radius(random.uniform(34, 40)), width(random.uniform(6, 9)) {}
  [[nodiscard]] double area() const {
    return 2 * half * radius * width + 0.25 * std::numbers::pi * width * width;
  }
  // From the circle's centre.
  [[nodiscard]] double centroid() const { return radius * std::sin(half) / half; }
  // Turned by `roll` about its centroid, which is in the picture's middle, and with a round spot beside it.
  [[nodiscard]] Image<std::uint8_t> picture(double roll, TestRandom& random,
                                            const Eigen::Vector2d& spot = beside_the_picture,
                                            double spot_radius = 1) const {
    const Eigen::Rotation2Dd back(-roll);
    const auto distance = [&](const Eigen::Vector2d& pixel) {
      const Eigen::Vector2d p = back * (pixel - zoomed_middle) + Eigen::Vector2d(centroid(), 0);
      const double angle = std::clamp(std::atan2(p.y(), p.x()), -half, half);
      const Eigen::Vector2d nearest(radius * std::cos(angle), radius * std::sin(angle));
      return std::min((p - nearest).norm() - 0.5 * width, (pixel - spot).norm() - spot_radius);
    };
    return picture_of(distance, random);
  }
  // What of it still lies upon itself after a roll about its centroid: pieces move across themselves by
  // roll centroid() sin(angle).
  [[nodiscard]] double covered(double roll) const {
    return 1 - std::abs(roll) * centroid() * (1 - std::cos(half)) / (half * width);
  }
};

TEST(ZoomRange, EndsWhereAnArcIsRolledOffHalfOfItself) {
  for_random_cases(24, [](TestRandom& random) {
    const ArcFigure arc(random);
    const auto drawn = arc.picture(0, random);
    const double share = share_of(arc.area());
    // correlation_of(covered(edge), share, share) = 1/2
    const double edge = 0.5 * (1 - share) / (1 - arc.covered(1));
    const double side = random.integer(0, 1) == 1 ? 1 : -1;
    for (const double part : {random.uniform(0.1, 0.5), random.uniform(0.5, 0.85)}) {
      const double roll = side * part * edge;
      const ZoomCorrelation found = correlate_zoom(arc.picture(roll, random), drawn);
      EXPECT_EQ(found.reason, "") << part << " of " << edge << " rad";
      EXPECT_NEAR(found.peak, correlation_of(arc.covered(roll), share, share), 0.06);
      EXPECT_NEAR(found.ratio, 1,
                  part < 0.5 ? 0.05 : 0.2);  // The nearer to the edge, the flatter is the peak.
    }
    const double more = random.uniform(1.25, 1.6);
    const ZoomCorrelation refused = correlate_zoom(arc.picture(side * more * edge, random), drawn);
    EXPECT_NE(refused.reason, "") << more << " of " << edge << " rad: " << refused.peak;
  });
}

// Something else that is dark, beside the arc, moves the centroid; enlarging then lays one half of the arc
// upon itself.
TEST(ZoomRange, EndsWhereTheCentroidIsOffByLessThanTheArcsWidth) {
  double worst = 0;
  for_random_cases(24, [&](TestRandom& random) {
    const ArcFigure arc(random);
    const auto drawn = arc.picture(0, random);
    const Eigen::Vector2d way(random.uniform(-10, 10), random.integer(0, 1) == 1 ? 48 : -48);
    const auto ratio = [&](double off) {
      const double area = arc.area() * off / (std::abs(way.y()) - off);
      const double spot = std::sqrt(area / std::numbers::pi);
      return correlate_zoom(arc.picture(0, random, zoomed_middle + way, spot), drawn).ratio;
    };
    EXPECT_NEAR(ratio(random.uniform(0.05, 0.3) * arc.width), 1, 0.05);
    worst = std::max(worst, std::abs(ratio(random.uniform(0.85, 1.2) * arc.width) - 1));
  });
  EXPECT_GT(worst, 0.15);
}

}  // namespace
}  // namespace flexura
