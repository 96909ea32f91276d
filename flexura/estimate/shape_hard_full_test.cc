// Shapes and views that tell little: the answer is as good as its sigma says, or it is refused or doubted
// with the reason. Pictures are drawn, and seen as real ones are.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "flexura/estimate/picture_sighting.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/math/so3.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

constexpr double radius = 0.015;

// An arm of sections of 0.25 m that stands upright, or is turned by R_WB = `turn` times upright.
BentArm arm_of(const std::vector<Eigen::Vector2d>& bends) {
  BentArm bent;
  bent.arm.kind = ArmKind::spatial;
  bent.arm.sections.resize(bends.size(), {.length = 0.25, .radius = {radius, radius}});
  bent.state = ArmState::straight(bends.size());
  bent.state.bends = bends;
  return bent;
}

// A camera 2 m away from the arm's middle, `azimuth` from +Z towards +X.
View view_from_side(const BentArm& bent, double azimuth, double focal_length = 850,
                    const Eigen::Vector3d& aside = {0, 0, 0}) {
  const Backbone backbone = bent.backbone();
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position + aside;
  const Eigen::Vector3d from = middle + 2 * Eigen::Vector3d(std::sin(azimuth), 0.03, std::cos(azimuth));
  return pinhole_view(look_at(from, middle), 640, 480, focal_length);
}

std::vector<Sighting> photographed(const BentArm& bent, const std::vector<View>& views, std::uint64_t seed) {
  Scene scene;
  scene.background = Color::Constant(0.85);
  scene.arm.tube = tube_of(bent.arm, bent.backbone());
  scene.arm.albedo = {0.08, 0.08, 0.09};
  std::vector<Sighting> seen;
  for (const View& view : views) {
    ArmFinder finder({.threshold = {}, .base = view.project(bent.arm.X_WB.position)});
    const SeenArmConfig options{.noise = 1};
    seen.push_back(sighting_of(finder.find(photograph(scene, view, options, seed++)), view));
  }
  return seen;
}

struct Outcome {
  ShapeEstimate found;
  double sigma = 0;   // Root mean square along the arm, m.
  double error = 0;   // Likewise.
  double excess = 0;  // The largest error in sigmas anywhere.
  double square = 0;  // The mean of their squares along the arm.
  [[nodiscard]] bool is_told() const { return !found.is_found || !found.notes.empty(); }
  // Three coordinates of few independent numbers: a mean square of nine is beyond the 0.1 % of chi-square.
  [[nodiscard]] bool is_covered() const { return found.is_found && square < 9; }
};

Outcome outcome(const BentArm& bent, const ShapePrior& prior, const std::vector<Sighting>& seen) {
  Outcome result{.found = ShapeEstimator(prior).estimate(seen)};
  if (!result.found.is_found) return result;
  const Backbone truth = bent.backbone(), shape(result.found.shape.arm, result.found.shape.state);
  const auto count = static_cast<double>(result.found.s.size() - 1);
  for (std::size_t i = 1; i < result.found.s.size(); ++i) {
    const double s = result.found.s[i], sigma = result.found.sigma[i];
    const double error =
        (shape.pose(std::min(s, shape.length())).position - truth.pose(std::min(s, truth.length())).position)
            .norm();
    result.sigma += sigma * sigma / count, result.error += error * error / count;
    result.excess = std::max(result.excess, error / sigma);
    result.square += error * error / (sigma * sigma) / count;
  }
  result.sigma = std::sqrt(result.sigma), result.error = std::sqrt(result.error);
  return result;
}

ShapePrior unknown(const BentArm& bent) { return unknown_arm(bent.arm.X_WB.position, bent.arm.length()); }

constexpr double quarter = 1.5707963267948966;

// Where the answer is given without a word, its sigma covers the error; otherwise the reason is told.
void expect_honest(const Outcome& one) {
  if (!one.found.is_found) {
    EXPECT_NE(one.found.reason, "");
    return;
  }
  EXPECT_TRUE(one.is_covered() || one.is_told()) << one.error << " m, sigma " << one.sigma;
}

// Of a known arm and of an unknown one, by hard views and by plain ones.
struct Comparison {
  std::array<Outcome, 2> hard, plain;

  Comparison(const BentArm& bent, const std::vector<View>& hard_views, const std::vector<View>& plain_views,
             std::uint64_t seed) {
    const auto seen = photographed(bent, hard_views, seed), clear = photographed(bent, plain_views, seed);
    const std::array<ShapePrior, 2> priors = {ShapePrior{.arm = bent.arm}, unknown(bent)};
    for (std::size_t i = 0; i < 2; ++i) {
      hard[i] = outcome(bent, priors[i], seen), plain[i] = outcome(bent, priors[i], clear);
      expect_honest(hard[i]);
      EXPECT_TRUE(plain[i].is_covered()) << plain[i].found.reason << plain[i].error << " " << plain[i].sigma;
    }
  }
};

TEST(HardShapes, APlaneSeenEdgeOnByOneCamera) {
  // bend_x turns towards +X: the plane is XY, and a camera on X sees a line. The other one is not far from
  // it.
  const BentArm bent = arm_of({{0.9, 0}, {-1.1, 0}, {1.0, 0}});
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const Comparison views(bent, {view_from_side(bent, quarter), view_from_side(bent, 0.75 * quarter)},
                           {view_from_side(bent, -0.125 * quarter), view_from_side(bent, 0.125 * quarter)},
                           seed);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(views.hard[i].is_covered());
    EXPECT_GT(views.hard[0].sigma, 1.5 * views.plain[0].sigma);
    EXPECT_GT(views.hard[1].sigma, 1.1 * views.plain[1].sigma);
  }
}

TEST(HardShapes, APlaneThroughBothCameras) {
  // Both see a line: how far apart its points are is all that tells the shape.
  BentArm bent = arm_of({{0, 0.9}, {0, -1.1}, {0, 1.0}});
  bent.arm.X_WB.rotation = rotation_from_z({1, 0, 0});
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const std::vector<View> views = {view_from_side(bent, 0.1), view_from_side(bent, 0.8)};
    for (const ShapePrior& prior : {ShapePrior{.arm = bent.arm}, unknown(bent)}) {
      const Outcome one = outcome(bent, prior, photographed(bent, views, seed));
      expect_honest(one);
    }
  }
}

TEST(HardShapes, TheArmBeforeItself) {
  // A hairpin in the plane YZ: the camera on Z sees its two branches one before the other.
  const BentArm bent = arm_of({{0, 0.2}, {0, 2.6}, {0, 0.2}});
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const Comparison views(bent, {view_from_side(bent, 0), view_from_side(bent, quarter)},
                           {view_from_side(bent, quarter), view_from_side(bent, 0.5 * quarter)}, seed);
    // Of the known arm the branch that one camera does not see is told by its length.
    EXPECT_TRUE(views.hard[0].is_covered());
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_TRUE(views.hard[i].is_told());
      // Of the unknown one there may be no answer at all: others explain the images, too.
      if (i == 0 || views.hard[i].found.is_found) {
        EXPECT_GT(views.hard[i].sigma, 5 * views.plain[i].sigma);
      }
    }
  }
}

// How often the backbone's image crosses itself.
int crossings(const BentArm& bent, const View& view) {
  const Backbone backbone = bent.backbone();
  constexpr int count = 300;
  std::vector<Eigen::Vector2d> points;
  points.reserve(count + 1);
  for (int i = 0; i <= count; ++i)
    points.push_back(view.project(backbone.pose(backbone.length() * i / count).position).value());
  const auto side = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x() > 0;
  };
  int crossed = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    for (std::size_t j = i + 2; j + 1 < points.size(); ++j)
      if (side(points[i], points[i + 1], points[j]) != side(points[i], points[i + 1], points[j + 1]) &&
          side(points[j], points[j + 1], points[i]) != side(points[j], points[j + 1], points[i + 1]))
        ++crossed;
  return crossed;
}

// The least sigma from the view at `azimuth` and another one, in neither of which the arm crosses itself.
std::optional<double> plain_sigma(const BentArm& bent, const ShapePrior& prior, double azimuth) {
  std::optional<double> least;
  const View first = view_from_side(bent, azimuth);
  for (double turn = 0.5; turn < 2.7; turn += 0.4) {
    const View view = view_from_side(bent, azimuth - turn);
    if (crossings(bent, view) != 0) continue;
    const Outcome one = outcome(bent, prior, photographed(bent, {view, first}, 1));
    if (one.found.is_found) least = std::min(one.sigma, least.value_or(one.sigma));
  }
  return least;
}

TEST(HardShapes, TheArmAcrossItselfInOnePicture) {
  int count = 0, found = 0, compared = 0, tries = 0;
  for (TestRandom random(1); count < 12 && tries < 800; ++tries) {
    std::vector<Eigen::Vector2d> bends(4);
    for (Eigen::Vector2d& bend : bends) bend = random.vector<2>(-2, 2);
    const BentArm bent = arm_of(bends);
    const std::vector<View> views = {view_from_side(bent, 0), view_from_side(bent, quarter)};
    if (crossings(bent, views[0]) != 1 || crossings(bent, views[1]) != 0) continue;
    const auto seen = photographed(bent, views, 1);
    for (const ShapePrior& prior : {ShapePrior{.arm = bent.arm}, unknown(bent)}) {
      const Outcome one = outcome(bent, prior, seen);
      expect_honest(one);
      ++count, found += one.found.is_found ? 1 : 0;
      // A known arm's sections tell what lies under the crossing; an unknown one's shape is not known there.
      if (prior.is_base_direction_known || !one.found.is_found) continue;
      const auto plain = plain_sigma(bent, prior, quarter);
      constexpr double tells = 2e-3;  // m
      if (!plain || *plain > tells) continue;
      ++compared;
      EXPECT_GT(one.sigma, 2 * *plain);
    }
  }
  EXPECT_GE(count, 12);
  // Most of them cross themselves so near an end, or so flatly, that the rest of the axis is not found.
  EXPECT_GE(found, 4);
  EXPECT_GE(compared, 2);
}

TEST(HardShapes, PartOfTheArmOutsideOnePicture) {
  const BentArm bent = arm_of({{0.6, 0.5}, {-0.7, 0.4}, {0.6, -0.7}});
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const Comparison views(bent, {view_from_side(bent, 0), view_from_side(bent, quarter, 850, {0, -0.35, 0})},
                           {view_from_side(bent, 0), view_from_side(bent, quarter)}, seed);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_TRUE(views.hard[i].is_covered());
      EXPECT_GT(views.hard[i].sigma, 1.5 * views.plain[i].sigma);
    }
    // Of an arm that may bend as it likes, the part that one camera sees alone is doubted.
    EXPECT_TRUE(views.hard[1].is_told());
  }
}

}  // namespace
}  // namespace flexura
