#include "flexura/control/shape_features.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/control/interaction.h"
#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/arms.h"
#include "tests/support/cameras.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

FeatureSet all_features() {
  FeatureSet set = FeatureSet::of_points(4);
  set.chords = {{0.0, 0.3}, {0.4, 0.5}, {0.9, 1.0}};
  set.has_moments = true;
  set.moment_points = 20;
  return set;
}

// Cameras with distortion and zoom, heads turned, that look at the arm's middle from about four lengths off.
std::vector<View> random_views(TestRandom& random, const Arm& arm, const ArmState& state) {
  const Backbone backbone(arm, state);
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position;
  std::vector<View> views;
  for (int i = 0; i < 2; ++i) {
    CameraConfig config = random_camera(random);
    const Eigen::Vector3d way(random.uniform(-1, 1), random.uniform(-0.3, 0.3), i == 0 ? 1.0 : -1.0);
    const Eigen::Vector3d eye = middle + 4 * backbone.length() * way.normalized();
    for (int k = 0; k < 3; ++k)
      config.mount.position[static_cast<std::size_t>(k)] = eye[k],
      (*config.mount.look_at)[static_cast<std::size_t>(k)] = middle[k];
    const Camera camera(config);
    HeadState head = camera.initial_head();
    head.zoom = random_head(random, camera).zoom;
    head.pan = random.uniform(-0.03, 0.03), head.tilt = random.uniform(-0.03, 0.03);
    views.push_back(camera.view({head, random_stage(random, camera)}));
  }
  return views;
}

View moved(View view, const Eigen::VectorXd& twist) {
  view.X_WC.position += view.X_WC.rotation * twist.head<3>();
  view.X_WC.rotation = (view.X_WC.rotation * so3_exp(twist.tail<3>())).eval();
  return view;
}

TEST(ShapeFeatures, HaveTheDerivativesOfTheirValues) {
  int seen = 0;
  for_random_cases(60, [&](TestRandom& random) {
    const Arm arm = random_arm(random);
    ArmState state = random_state(random, arm);
    for (Eigen::Vector2d& bend : state.bends) bend *= 0.2;
    const std::vector<View> views = random_views(random, arm, state);
    const FeatureSet set = all_features();
    const auto features = shape_features(arm, state, views, set);
    if (!features) return;  // Outside of what a lens shows.
    ++seen;
    const Eigen::VectorXd& desired = features->values;
    const auto by_state = numerical_jacobian(
        [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
          return feature_error(set, shape_features(arm, unpacked(q), views, set).value().values, desired);
        },
        packed(state), 1e-3);
    const auto by_cameras = numerical_jacobian(
        [&](const Eigen::VectorXd& twists) -> Eigen::VectorXd {
          const std::vector<View> there = {moved(views[0], twists.head<6>()),
                                           moved(views[1], twists.tail<6>())};
          return feature_error(set, shape_features(arm, state, there, set).value().values, desired);
        },
        Eigen::VectorXd::Zero(12), 1e-3);
    for (Eigen::Index row = 0; row < desired.size(); ++row) {
      const double scale = 1 + by_state.value.row(row).norm(),
                   camera_scale = 1 + by_cameras.value.row(row).norm();
      EXPECT_LE((features->by_state - by_state.value).row(row).norm(), 1e-6 * scale) << "row " << row;
      EXPECT_LE((features->by_cameras - by_cameras.value).row(row).norm(), 1e-6 * camera_scale)
          << "row " << row;
    }
  });
  EXPECT_GE(seen, 30 / one_case_of);
}

TEST(ShapeFeatures, OfPointsAreTheCamerasPixels) {
  const Arm arm = servo_arm();
  const ArmState state = {{{0.4, 0.1}, {-0.2, 0.5}, {0.3, 0.3}}, {1, 1, 1}};
  const auto views = servo_views();
  const auto features = shape_features(arm, state, views, FeatureSet::of_points(5));
  ASSERT_TRUE(features.has_value());
  ASSERT_EQ(features->values.size(), 20);
  const Backbone backbone(arm, state);
  for (Eigen::Index i = 0; i < 5; ++i) {
    const Eigen::Vector3d place =
        backbone.pose(0.2 * static_cast<double>(i + 1) * backbone.length()).position;
    EXPECT_LE((features->values.segment<2>(2 * i) - views[0].project(place).value()).norm(), 1e-9);
    EXPECT_LE((features->values.segment<2>(10 + 2 * i) - views[1].project(place).value()).norm(), 1e-9);
  }
}

TEST(Interaction, OfAPointIsTheTextbooks) {
  for_random_cases(100, [](TestRandom& random) {
    const Eigen::Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.5, 5));
    const double x = p.x() / p.z(), y = p.y() / p.z(), Z = p.z();
    Eigen::Matrix<double, 2, 6> expected;
    expected << -1 / Z, 0, x / Z, x * y, -(1 + x * x), y, 0, -1 / Z, y / Z, 1 + y * y, -x * y, -x;
    const auto L = point_interaction(Lens({.fx = 1, .fy = 1, .cx = 0, .cy = 0}), p);
    ASSERT_TRUE(L.has_value());
    EXPECT_LE((*L - expected).cwiseAbs().maxCoeff(), 1e-14 * (1 + expected.cwiseAbs().maxCoeff()));
  });
  EXPECT_FALSE(point_interaction(Lens(Intrinsics{}), {0, 0, -1}).has_value());
}

TEST(CurveMoments, OfACircleAndALineAreInClosedForm) {
  constexpr int count = 2000;
  Eigen::Matrix2Xd circle(2, count + 1), line(2, 4);
  for (int i = 0; i <= count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    circle.col(i) << 300 + 50 * std::cos(angle), 200 + 50 * std::sin(angle);
  }
  const auto moments = curve_moments(circle).values;
  EXPECT_NEAR(moments[0], 2 * std::numbers::pi * 50, 1e-3);
  EXPECT_NEAR(moments[1], 300, 1e-9);
  EXPECT_NEAR(moments[2], 200, 1e-9);
  EXPECT_NEAR(moments[3], 1250, 1e-2);
  EXPECT_NEAR(moments[4], 0, 1e-9);
  EXPECT_NEAR(moments[5], 1250, 1e-2);
  // A line's do not ask where its points are.
  line << 0, 3, 60, 90, 0, 4, 80, 120;
  const auto straight = curve_moments(line).values;
  EXPECT_NEAR(straight[0], 150, 1e-12);
  EXPECT_NEAR(straight[1], 45, 1e-12);
  EXPECT_NEAR(straight[2], 60, 1e-12);
  EXPECT_NEAR(straight[3], 675, 1e-10);
  EXPECT_NEAR(straight[4], 900, 1e-10);
  EXPECT_NEAR(straight[5], 1200, 1e-10);
  EXPECT_THROW((void)curve_moments(line.leftCols(1)), std::domain_error);
  EXPECT_THROW((void)curve_moments(Eigen::Matrix2Xd::Ones(2, 5)), std::domain_error);
}

TEST(ShapeFeatures, DifferByLessThanHalfATurn) {
  FeatureSet set = FeatureSet::of_chords(2);
  const double turn = 2 * std::numbers::pi * set.angle_weight;
  const Eigen::Vector2d seen(0.49 * turn, -0.2 * turn), desired(-0.49 * turn, 0.1 * turn);
  const Eigen::VectorXd error = feature_error(set, seen, desired);
  EXPECT_NEAR(error[0], -0.02 * turn, 1e-9);
  EXPECT_NEAR(error[1], -0.3 * turn, 1e-9);
  EXPECT_THROW((void)feature_error(set, seen, Eigen::VectorXd::Zero(4)), std::invalid_argument);
}

TEST(ShapeFeatures, AreNoneWhereACameraShowsNone) {
  const Arm arm = servo_arm();
  const ArmState straight = ArmState::straight(3);
  View below = servo_views()[0];
  below.X_WC = {rotation_from_z(Eigen::Vector3d::UnitY()), {0, -2, 0}};
  // The arm points away from this camera: its images of chords are points.
  EXPECT_FALSE(shape_features(arm, straight, std::array{below}, FeatureSet::of_chords(3)).has_value());
  below.X_WC.position.y() = 0.5;  // Behind it.
  EXPECT_FALSE(shape_features(arm, straight, std::array{below}, FeatureSet::of_points(3)).has_value());
  EXPECT_THROW((void)shape_features(arm, straight, std::array{below}, {}), std::invalid_argument);
  EXPECT_THROW((void)shape_features(arm, straight, servo_views(), FeatureSet{.points = {1.1}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace flexura
