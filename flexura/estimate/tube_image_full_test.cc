// The rims of projected tubes, compared with sampled surfaces and finite differences.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/estimate/tube_image.h"
#include "flexura/model/backbone.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

struct Case {
  ShapePrior prior;
  Shape shape;
  std::vector<Observation> observations;
};

Case random_case(TestRandom& random) {
  Case one;
  const BentArm bent = random_bent_arm(random, 0);
  one.prior.arm = bent.arm;
  one.shape = {bent.arm, bent.state, std::vector<ViewError>(2)};
  for (Eigen::Vector2d& bend : one.shape.state.bends) bend *= 0.5;
  const Eigen::Vector3d middle = Backbone(bent.arm, one.shape.state).pose(0.5).position;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d way = i == 0 ? Eigen::Vector3d(0.1, 0.2, 1) : Eigen::Vector3d(-1, 0.1, 0.1);
    Observation seen;
    seen.view = pinhole_view(look_at(middle + 2.2 * way, middle), 640, 480, 700);
    one.observations.push_back(seen);
  }
  return one;
}

// Near a rim, no point of the tube's surface is farther outwards, and one is as far.
TEST(TubeImage, RimsBoundTheTubesSurface) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    TestRandom random(seed);
    Case one = random_case(random);
    TubeImage image(one.prior, one.observations);
    const Eigen::Index count = ShapeVariables(one.prior, one.observations).count();
    ASSERT_TRUE(image.set(one.shape, 1e-4 * Eigen::MatrixXd::Identity(count, count)));
    const Backbone backbone(one.shape.arm, one.shape.state);
    std::vector<TubeSection> sections;
    image.sections(0, sections);
    std::size_t checked = 0;
    for (std::size_t k = 2; k + 2 < sections.size(); k += 5) {
      if (!sections[k].is_measurable) continue;
      const double s =
          backbone.length() * (static_cast<double>(k) + 0.5) / static_cast<double>(sections.size());
      for (const ExpectedRim& rim : sections[k].expected.rims) {
        double farthest = -1e9;
        for (int a = -10; a <= 10; ++a) {
          const Pose X_WS = backbone.pose(std::clamp(s + 0.0008 * a, 0.0, backbone.length()));
          for (int b = 0; b < 720; ++b) {
            const double angle = b * std::numbers::pi / 360;
            const Eigen::Vector3d point =
                X_WS * Eigen::Vector3d(0.025 * std::cos(angle), 0.025 * std::sin(angle), 0);
            const Eigen::Vector2d pixel = *one.observations[0].view.project(point);
            // Only near the rim's point, where the border is nearly straight.
            if ((pixel - rim.pixel).norm() < 0.45)
              farthest = std::max(farthest, rim.outward.dot(pixel - rim.pixel));
          }
        }
        EXPECT_NEAR(farthest, 0, 0.03) << "seed " << seed << ", section " << k;
        ++checked;
      }
    }
    EXPECT_GT(checked, 8U);
  }
}

TEST(TubeImage, ReachIsTheStandardDeviationOfTheBackbonesImage) {
  TestRandom random(3);
  Case one = random_case(random);
  const ShapeVariables variables(one.prior, one.observations);
  TubeImage image(one.prior, one.observations);
  for (Eigen::Index k = 0; k < variables.count(); ++k) {
    constexpr double sigma = 0.05, step = 1e-5;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(variables.count(), variables.count());
    covariance(k, k) = sigma * sigma;
    ASSERT_TRUE(image.set(one.shape, covariance));
    std::vector<TubeSection> before, after;
    image.sections(1, before);
    Eigen::VectorXd change = Eigen::VectorXd::Zero(variables.count());
    change[k] = step;
    ASSERT_TRUE(image.set(variables.plus(one.shape, change), covariance));
    image.sections(1, after);
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (!before[i].is_measurable) continue;
      const double moved = before[i].normal.dot(after[i].pixel - before[i].pixel) / step;
      EXPECT_NEAR(before[i].expected.reach, sigma * std::abs(moved), 0.02 + 0.01 * sigma * std::abs(moved));
    }
  }
}

TEST(TubeImage, HasNoRimsWhereTheArmIsBehindItself) {
  Case one;
  one.prior.arm.kind = ArmKind::spatial;
  one.prior.arm.sections.assign(2, {.length = 0.5, .radius = {0.02, 0.02}});
  // A loop that crosses itself in the picture.
  one.shape = {one.prior.arm, ArmState::straight(2), {}};
  one.shape.state.bends = {{2.6, 0.3}, {2.6, 0.3}};
  Observation seen;
  const Backbone backbone(one.shape.arm, one.shape.state);
  seen.view = pinhole_view(look_at({0, 0.2, 2}, {0, 0.2, 0}), 640, 480, 900);
  one.observations = {seen};
  TubeImage image(one.prior, one.observations);
  const Eigen::Index count = ShapeVariables(one.prior, one.observations).count();
  ASSERT_TRUE(image.set(one.shape, 1e-4 * Eigen::MatrixXd::Identity(count, count)));
  std::vector<TubeSection> sections;
  image.sections(0, sections);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    for (std::size_t j = 0; j < sections.size(); ++j) {
      if (!sections[i].is_measurable || !sections[j].is_measurable) continue;
      // The first and the last part of the loop are far apart along the arm.
      if (i + sections.size() / 2 > j) continue;
      for (const ExpectedRim& rim : sections[i].expected.rims) {
        const bool is_covered = (rim.pixel - sections[j].pixel).norm() < 0.4 * sections[j].expected.width;
        if (is_covered) {
          EXPECT_FALSE(rim.is_visible);
        }
      }
    }
  }
}

}  // namespace
}  // namespace flexura
