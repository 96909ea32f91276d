#include "flexura/estimate/shape_silhouette.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/model/backbone.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// The misfit by exhaustive search over many points along the arm.
double misfit_by_places(const Observation& seen, const Shape& shape) {
  constexpr int count = 4000;
  constexpr double close = 1.5, far = 3;  // px
  const Backbone backbone(shape.arm, shape.state);
  const double radius = shape.arm.sections.front().radius[0];
  double sum = 0;
  for (const Eigen::Vector2d& pixel : seen.figure) {
    double nearest = 1e9;
    for (int k = 0; k <= count; ++k) {
      const Eigen::Vector3d place = backbone.pose(backbone.length() * k / count).position,
                            p = seen.view.X_WC.inverse() * place;
      const double slant = p.norm() / p.z(),
                   widest = radius * seen.view.lens.intrinsics().fx / p.norm() * slant * slant;
      nearest = std::min(nearest, (*seen.view.project(place) - pixel).norm() - widest);
    }
    const double off = std::max(0.0, nearest - close);
    sum += off * off / (1 + off * off / (far * far));
  }
  return sum / static_cast<double>(seen.figure.size());
}

// No part of the arm is missed, whatever its shape: the nearest part counts for each pixel.
TEST(ShapeSilhouette, CountsTheNearestPartOfTheArmForEachPixel) {
  for_random_cases(12, [](TestRandom& random) {
    const auto between = [&](double low, double high) { return random.uniform(low, high); };
    Observation seen;
    seen.view = {Lens(Intrinsics{.fx = 800, .fy = 800, .cx = 319.5, .cy = 239.5}), Pose{}, 640, 480};
    Shape shape;
    shape.arm.kind = ArmKind::spatial;
    shape.arm.X_WB.position = {between(-0.3, 0.3), between(-0.3, 0.3), between(1.5, 2.5)};
    shape.arm.X_WB.rotation =
        Eigen::AngleAxisd(between(-3, 3), Eigen::Vector3d(1, 0.5, 0.2).normalized()).toRotationMatrix();
    const double radius = between(0.005, 0.02);
    shape.arm.sections.resize(3, {.length = 0.3, .radius = {radius, radius}});
    for (int i = 0; i < 3; ++i) shape.state.bends.emplace_back(between(-2, 2), between(-2, 2));
    shape.state.stretches = {1, 1, 1};
    const Backbone backbone(shape.arm, shape.state);
    for (int i = 0; i < 60; ++i) {
      const auto pixel = seen.view.project(backbone.pose(between(0, backbone.length())).position).value();
      seen.figure.emplace_back(pixel + Eigen::Vector2d(between(-25, 25), between(-25, 25)));
    }
    const double expected = misfit_by_places(seen, shape);
    EXPECT_GT(expected, 0.1);
    EXPECT_NEAR(misfit(seen, {}, shape), expected, 0.01 * expected + 0.01);
    for (Section& section : shape.arm.sections) section.radius = {0, 0};
    EXPECT_EQ(misfit(seen, {}, shape), 0);
  });
}

}  // namespace
}  // namespace flexura
