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
#include "flexura/control/feature_images.h"
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

// Returns cameras with distortion, zoom and turned heads that look at the arm's middle from about four
// lengths away.
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

TEST(ShapeFeatures, HaveTheDerivativesOfTheirValues) {
  int seen = 0;
  for_random_cases(60, [&](TestRandom& random) {
    const Arm arm = random_arm(random);
    ArmState state = random_state(random, arm);
    for (Eigen::Vector2d& bend : state.bends) bend *= 0.2;
    const std::vector<View> views = random_views(random, arm, state);
    const FeatureSet set = all_features();
    FeatureImages images(arm, set);
    Eigen::VectorXd desired, there;
    Eigen::MatrixXd by_state;
    if (!images.derive(state, views, desired, by_state)) return;  // Outside the lens's view.
    ++seen;
    const auto desired = numerical_jacobian(
        [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
          EXPECT_TRUE(images.values(unpacked(q), views, there));
          return feature_error(set, there, desired);
        },
        packed(state), 1e-3);
    for (Eigen::Index row = 0; row < desired.size(); ++row)
      EXPECT_LE((by_state - desired.value).row(row).norm(), 1e-6 * (1 + desired.value.row(row).norm()))
          << "row " << row;
  });
  EXPECT_GE(seen, 30 / one_case_of);
}

TEST(ShapeFeatures, OfPointsAreTheCamerasPixels) {
  const Arm arm = servo_arm();
  const ArmState state = {{{0.4, 0.1}, {-0.2, 0.5}, {0.3, 0.3}}, {1, 1, 1}};
  const auto views = servo_views();
  Eigen::VectorXd values;
  ASSERT_TRUE(FeatureImages(arm, FeatureSet::of_points(5)).values(state, views, values));
  ASSERT_EQ(values.size(), 20);
  const Backbone backbone(arm, state);
  for (Eigen::Index i = 0; i < 5; ++i) {
    const Eigen::Vector3d place =
        backbone.pose(0.2 * static_cast<double>(i + 1) * backbone.length()).position;
    EXPECT_LE((values.segment<2>(2 * i) - views[0].project(place).value()).norm(), 1e-9);
    EXPECT_LE((values.segment<2>(10 + 2 * i) - views[1].project(place).value()).norm(), 1e-9);
  }
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
  // Those of a line must not depend on its points.
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
  // The arm points away from this camera: the images of its chords are points.
  Eigen::VectorXd values;
  EXPECT_FALSE(FeatureImages(arm, FeatureSet::of_chords(3)).values(straight, std::array{below}, values));
  below.X_WC.position.y() = 0.5;  // Behind it.
  EXPECT_FALSE(FeatureImages(arm, FeatureSet::of_points(3)).values(straight, std::array{below}, values));
  EXPECT_THROW(FeatureImages(arm, {}), std::invalid_argument);
  EXPECT_THROW(FeatureImages(arm, FeatureSet{.points = {1.1}}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
