#include "flexura/control/contour_images.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/math/derivative_check.h"
#include "flexura/model/backbone.h"
#include "flexura/render/renderer.h"
#include "flexura/render/silhouette.h"
#include "tests/support/arms.h"
#include "tests/support/render_scenes.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

// Returns a view of an arm of 1 m from a random direction, with a distorting lens.
View bent_view_of(TestRandom& random, const Backbone& backbone) {
  View view = random_view_of(random, backbone);
  view.lens = Lens({.fx = 250, .fy = 240, .distortion = {-0.1, 0.02, 0.001, -0.001, 0}});
  return view;
}

Scene scene_of(const BentArm& bent) {
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(bent.backbone());
  scene.arm.tip = TipKind::flat;
  return scene;
}

// Pixel and normal of the contour at a share of the arm, on one side.
struct EdgePoint {
  Eigen::Vector2d pixel, normal;
};
EdgePoint edge_point(const Arm& arm, const ArmState& state, const View& view, double share,
                     Eigen::Index side) {
  ContourImages contours(arm, {share});
  contours.set(state);
  ContourImage image;
  EXPECT_TRUE(contours.see(view, image));
  return {image.pixels.col(side), image.normals.col(side)};
}

// Returns the distance of a contour from `from` along its normal there: follows the contour to where it
// crosses that line, at any share of the arm.
double crossing(const Arm& arm, const ArmState& state, const View& view, const EdgePoint& from, double share,
                Eigen::Index side) {
  const Eigen::Vector2d heading(-from.normal.y(), from.normal.x());
  const auto off = [&](double s) {
    return Eigen::Vector2d(edge_point(arm, state, view, s, side).pixel - from.pixel);
  };
  constexpr double apart = 1e-3;
  double before = share - apart, here = share;
  double value_before = heading.dot(off(before)), value = heading.dot(off(here));
  for (int k = 0; k < 20 && std::abs(value) > 1e-12 && value != value_before; ++k) {
    const double next = here - value * (here - before) / (value - value_before);
    before = here, value_before = value;
    here = next, value = heading.dot(off(here));
  }
  return from.normal.dot(off(here));
}

TEST(ContourImages, AreWhereTheRendererHasTheOutline) {
  int compared = 0;
  double worst = 0;
  for (const double taper : {0.0, 0.006}) {
    for_random_cases(20, [&](TestRandom& random) {
      const BentArm bent = random_bent_arm(random, taper);
      const Backbone backbone = bent.backbone();
      const View view = bent_view_of(random, backbone);
      const Scene scene = scene_of(bent);
      Renderer renderer;
      renderer.prepare(scene, view);
      for (const Outline& outline : outlines(renderer, 20)) {
        if (outline.kind == OutlineKind::rim) continue;
        for (const OutlinePoint& point : outline.points) {
          if (!point.pixel) continue;
          ContourImages contours(bent.arm, {std::min(1.0, point.s / backbone.length())});
          contours.set(bent.state);
          ContourImage image;
          ASSERT_TRUE(contours.see(view, image));
          // Where a contour turns back on itself, rounding decides whether it exists.
          if (!image.has(0)) continue;
          const double off =
              std::min((image.places.col(0) - point.p_CP).norm(), (image.places.col(1) - point.p_CP).norm());
          const double near_turn = (image.places.col(0) - image.places.col(1)).norm();
          if (near_turn < 1e-3) continue;
          worst = std::max(worst, off), ++compared;
          EXPECT_LT(off, 1e-9);
        }
      }
    });
  }
  std::printf("%d points, farthest from the renderer's %.1e m\n", compared, worst);
  EXPECT_GT(compared, 200 / one_case_of);
}

// Compares the whole curve in another state with the derivatives: the correspondence of its points is
// unknown.
TEST(ContourImages, MoveAlongTheirNormalsAsTheirDerivativesSay) {
  int compared = 0;
  for (const double taper : {0.0, 0.006}) {
    for_random_cases(10, [&](TestRandom& random) {
      BentArm bent = random_bent_arm(random, taper);
      for (double& stretch : bent.state.stretches) stretch = random.uniform(0.9, 1.1);
      const View view = bent_view_of(random, bent.backbone());
      // Away from the ends of sections, where the contour's curvature is discontinuous.
      const std::vector<double> shares = {0.15, 0.5, 0.85};
      ContourImages contours(bent.arm, shares);
      contours.set(bent.state);
      ContourImage image;
      if (!contours.see(view, image)) return;
      Eigen::MatrixXd by_state(contours.count(), contours.columns());
      contours.derive(view, image, by_state);
      for (Eigen::Index i = 0; i < contours.count(); ++i) {
        // Near a turn of the contour its normal turns within the step of the differences.
        if (!image.has(i) || (image.places.col(i) - image.places.col(i ^ 1)).norm() < 0.02) continue;
        const double share = shares[static_cast<std::size_t>(i / 2)];
        const EdgePoint from{image.pixels.col(i), image.normals.col(i)};
        const Eigen::VectorXd row = numerical_jacobian(
                                        [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
                                          return Eigen::VectorXd::Constant(
                                              1, crossing(bent.arm, unpacked(q), view, from, share, i % 2));
                                        },
                                        packed(bent.state), 1e-3)
                                        .value.row(0)
                                        .transpose();
        ++compared;
        EXPECT_LT((by_state.row(i).transpose() - row).norm(), 1e-5 * (1 + row.norm()));
      }
    });
  }
  EXPECT_GT(compared, 40 / one_case_of);
}

TEST(ContourImages, OfAStraightTubeAreInClosedForm) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.push_back({.length = 1, .radius = {0.05, 0.05}});
  const View view = pinhole_view(look_at({0, 0.5, 2}, {0, 0.5, 0}), 200, 200, 150);
  ContourImages contours(arm, {0.25, 0.5});
  contours.set(ArmState::straight(1));
  ContourImage image;
  ASSERT_TRUE(contours.see(view, image));
  const double off = 150 * 0.05 / std::sqrt(2 * 2 - 0.05 * 0.05);
  // The arm is upright in the picture: right of its direction is right.
  EXPECT_NEAR(image.pixels(0, 2), 99.5 + off, 1e-9);
  EXPECT_NEAR(image.pixels(0, 3), 99.5 - off, 1e-9);
  EXPECT_NEAR(image.normals(0, 2), 1, 1e-12);
  EXPECT_NEAR(image.normals(0, 3), -1, 1e-12);
  // The whole arm leans to the right, by bend/2 at its middle: both edges move with it, one outwards and one
  // inwards.
  Eigen::MatrixXd by_state(4, 3);
  contours.derive(view, image, by_state);
  const double depth = 2 - 0.05 * 0.05 / 2;  // Depth of the points where rays touch.
  const double rate = 150 * 0.125 / depth * std::sqrt(1 - 0.05 * 0.05 / 4);
  EXPECT_NEAR(std::abs(by_state(2, 0)), rate, 0.01 * rate);
  EXPECT_NEAR(by_state(2, 0), -by_state(3, 0), 1e-9);
}

// A piece of edge turns about a point by any angle below half a turn. Its error must be the chord of its way,
// for any slip along its middle direction.
TEST(ContourError, IsTheWayOfAnEdgeThatTurns) {
  for_random_cases(100, [](TestRandom& random) {
    const double from = random.uniform(-3, 3), turn = random.uniform(-3, 3), radius = random.uniform(1, 50);
    const auto unit = [](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
    const Eigen::Vector2d pivot = random.vector<2>(0, 100);
    ContourImage at;
    // The edge is along the radius: its normal is perpendicular to it.
    at.normals = unit(from + turn + 0.5 * std::numbers::pi);
    const Eigen::Vector2d slip = random.uniform(-5, 5) * unit(from + 0.5 * turn);
    const Eigen::Matrix2Xd seen = pivot + radius * unit(from + turn) + slip,
                           desired = pivot + radius * unit(from),
                           normals = unit(from + 0.5 * std::numbers::pi);
    at.pixels = seen;
    Eigen::VectorXd error(1);
    contour_error(at, seen, desired, normals, error);
    EXPECT_NEAR(error[0], 2 * radius * std::sin(0.5 * turn), 1e-9);
  });
}

TEST(HalfwayNormals, AreThoseBetweenAndNoneOfOppositesAndOfNone) {
  for_random_cases(30, [](TestRandom& random) {
    const double from = random.uniform(-3, 3), turn = random.uniform(-3, 3);
    const auto unit = [](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
    Eigen::Matrix2Xd one(2, 3), other(2, 3), middle(2, 3);
    one << unit(from), unit(from), unit(from);
    other << unit(from + turn), -unit(from), Eigen::Vector2d::Constant(std::nan(""));
    halfway_normals(one, other, middle);
    EXPECT_NEAR((middle.col(0) - unit(from + 0.5 * turn)).norm(), 0, 1e-12);
    EXPECT_FALSE(middle.col(1).allFinite());
    EXPECT_FALSE(middle.col(2).allFinite());
    EXPECT_THROW(halfway_normals(one, other.leftCols(2), middle), std::invalid_argument);
  });
}

TEST(ContourImages, AreNoneWhereTheArmPointsAtTheCamera) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.push_back({.length = 1, .radius = {0.05, 0.05}});
  const View above = pinhole_view(look_at({0, 3, 0}, {0, 0, 0}, {1, 0, 0}), 100, 100, 100);
  ContourImages contours(arm, {0.5, 1});
  contours.set(ArmState::straight(1));
  ContourImage image;
  ASSERT_TRUE(contours.see(above, image));
  Eigen::MatrixXd by_state(4, 3);
  contours.derive(above, image, by_state);
  Eigen::VectorXd error(4);
  contour_error(image, Eigen::Matrix2Xd::Ones(2, 4), Eigen::Matrix2Xd::Zero(2, 4),
                Eigen::Matrix2Xd::Ones(2, 4), error);
  EXPECT_FALSE(image.has(0) || image.has(3));
  EXPECT_EQ(by_state.norm(), 0);
  EXPECT_EQ(error.norm(), 0);
  // Behind the camera, the lens shows nothing.
  EXPECT_FALSE(
      contours.see(pinhole_view(look_at({0.5, 3, 0}, {0.5, 4, 0}, {1, 0, 0}), 100, 100, 100), image));
  EXPECT_THROW(ContourImages(arm, {-0.1}), std::invalid_argument);
  EXPECT_THROW(contour_error(image, Eigen::Matrix2Xd::Ones(2, 3), Eigen::Matrix2Xd::Zero(2, 4),
                             Eigen::Matrix2Xd::Ones(2, 4), error),
               std::invalid_argument);
}

}  // namespace
}  // namespace flexura
