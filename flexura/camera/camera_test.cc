#include "flexura/camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "flexura/base/degree.h"
#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "tests/support/cameras.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(Head, PansToTheLeftAndTiltsUp) {
  const Eigen::Vector3d forward(0, 0, 1);
  EXPECT_LE((pan_rotation(0.3) * forward - Eigen::Vector3d(-std::sin(0.3), 0, std::cos(0.3))).norm(), 1e-15);
  EXPECT_LE((tilt_rotation(0.3) * forward - Eigen::Vector3d(0, -std::sin(0.3), std::cos(0.3))).norm(), 1e-15);
  // Pan comes first, about the mount's axis: panning a head that looks up by 90 degrees does not move its
  // axis.
  EXPECT_LE((head_pose({}, 1.0, 90 * degree).rotation.col(2) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-15);
}

TEST(Head, CarriesThePupilAroundItsAxes) {
  const HeadGeometry geometry{{0.01, -0.02, 0.03}, {0.001, 0.002, 0.05}};
  const Pose straight = head_pose(geometry, 0, 0);
  EXPECT_LE((straight.position - Eigen::Vector3d(0.011, -0.018, 0.08)).norm(), 1e-15);
  const Pose left = head_pose(geometry, 90 * degree, 0);  // (x, y, z) goes to (-z, y, x)
  EXPECT_LE((left.position - Eigen::Vector3d(-0.08, -0.018, 0.011)).norm(), 1e-15);
  const Pose up = head_pose(geometry, 0, 90 * degree);  // the pupil's (x, y, z) goes to (x, -z, y)
  EXPECT_LE((up.position - Eigen::Vector3d(0.011, -0.07, 0.032)).norm(), 1e-15);
}

TEST(Head, CommandsGoToTheNearestPositionThatThereIs) {
  const AxisConfig axis{.limits = {-1, 2.25}, .resolution = 0.5};
  EXPECT_EQ(commandable(axis, 0.7), 0.5);
  EXPECT_EQ(commandable(axis, -0.8), -1);
  EXPECT_EQ(commandable(axis, 7), 2);
  EXPECT_EQ(commandable(axis, -7), -1);
  EXPECT_EQ(commandable({.limits = {0.1, 0.2}, .resolution = 0.5}, 0.15), 0.15);
  EXPECT_EQ(commandable({.limits = {-1, 1}}, 0.123), 0.123);
}

TEST(Mount, LooksAtItsPointUpright) {
  for_random_cases(200, [](TestRandom& random) {
    MountConfig mount;
    for (double& coordinate : mount.position) coordinate = random.uniform(-3, 3);
    mount.look_at = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    mount.roll = random.uniform(-3.1, 3.1);
    const Pose X_WM = mount.pose();
    const Eigen::Vector3d way = Eigen::Map<const Eigen::Vector3d>(mount.look_at->data()) - X_WM.position;
    EXPECT_LE((X_WM.rotation.col(2) - way.normalized()).norm(), 1e-14);
    EXPECT_NEAR(X_WM.rotation.determinant(), 1, 1e-14);
    EXPECT_NEAR(*roll_of(X_WM.rotation), mount.roll, 1e-9);
    const Eigen::Matrix3d without_roll = X_WM.rotation * so3_exp({0, 0, -mount.roll});
    EXPECT_NEAR(without_roll.col(0).y(), 0, 1e-14);  // Its x is level, its y points down.
    EXPECT_LT(without_roll.col(1).y(), 0);
  });
}

TEST(Mount, PanAndTiltOnAnUprightMountMakeNoRollAndCorrectNone) {
  CameraConfig config = cameras_at({5, 5})[0];
  const Camera upright_camera(config);
  config.mount.roll = 0.1;
  const Camera rolled(config);
  EXPECT_NEAR(*roll_of(upright_camera.pose({{0.4, 0.3, 1}, {}}).rotation), 0, 1e-15);
  EXPECT_NEAR(*roll_of(rolled.pose({{0, 0, 1}, {}}).rotation), 0.1, 1e-15);
  EXPECT_NEAR(*roll_of(rolled.pose({{0.05, 0.02, 1}, {}}).rotation), 0.1, 0.01);
  EXPECT_FALSE(roll_of(tilt_rotation(90 * degree)));
}

TEST(Mount, RefusesOrientationsThatAreNone) {
  const auto refuses = [](auto&& spoil) {
    MountConfig mount;
    mount.look_at = {0, 0, -1};
    spoil(mount);
    EXPECT_THROW((void)mount.pose(), std::invalid_argument);
  };
  refuses([](MountConfig& mount) { mount.look_at.reset(); });
  refuses([](MountConfig& mount) { mount.rotation = {1, 0, 0, 0}; });
  refuses([](MountConfig& mount) { mount.look_at = {0, 0, 0}; });
  refuses([](MountConfig& mount) { mount.look_at = {0, 7, 0}; });
  refuses([](MountConfig& mount) { mount.look_at.reset(), mount.rotation = {1, 1, 0, 0}; });
  refuses([](MountConfig& mount) { mount.look_at.reset(), mount.rotation = {1, 0, 0, 0}, mount.roll = 1; });
}

TEST(Camera, SeesAsTheChainOfItsFramesSays) {
  for_random_cases(200, [](TestRandom& random) {
    const CameraConfig config = random_camera(random);
    const Camera camera(config);
    const HeadState head = random_head(random, camera);
    const StageState stage = random_stage(random, camera);
    const auto vector = [](const std::array<double, 3>& a) { return Eigen::Vector3d(a[0], a[1], a[2]); };
    const auto turn = [](const Eigen::Vector3d& w) { return Pose{so3_exp(w), Eigen::Vector3d::Zero()}; };
    const auto shift = [](const Eigen::Vector3d& p) { return Pose{Eigen::Matrix3d::Identity(), p}; };
    const double forward = config.head.pupil_shift * (camera.lens().ratio(head.zoom) - 1);
    const Pose X_WC = config.mount.pose() * shift(stage.offset) * turn({0, -head.pan, 0}) *
                      shift(vector(config.head.tilt_axis)) * turn({head.tilt, 0, 0}) *
                      shift(vector(config.head.pupil) + Eigen::Vector3d(0, 0, forward));
    const View view = camera.view({head, stage});
    EXPECT_LE((view.X_WC.rotation - X_WC.rotation).norm(), 1e-14);
    EXPECT_LE((view.X_WC.position - X_WC.position).norm(), 1e-14);
    const Eigen::Vector3d p_WP = X_WC * Eigen::Vector3d(0.1, -0.2, 1.5);
    const auto projection = camera.project(p_WP, {head, stage});
    const auto pixel = view.project(p_WP);
    ASSERT_EQ(projection.has_value(), pixel.has_value());
    if (!pixel) return;
    EXPECT_LE((projection->pixel - *pixel).norm(), 1e-9);
  });
}

// All parameters of a camera's pixel, as one vector.
class EveryParameter {
 public:
  EveryParameter(const CameraConfig& config, const StageState& stage, const HeadState& head,
                 const Eigen::Vector3d& p_WP)
      : config_(config), stage_(stage), head_(head), p_WP_(p_WP) {}

  static constexpr int count = 3 + 6 + 3 + 3 + 3 + 3 + 1;

  // The pixel at offsets x from the present parameters.
  [[nodiscard]] Eigen::VectorXd pixel(const Eigen::VectorXd& x) const {
    CameraConfig config = config_;
    Pose X_WM = config.mount.pose();
    X_WM = {so3_exp(x.segment<3>(6)) * X_WM.rotation, X_WM.position + x.segment<3>(3)};
    const Eigen::Vector4d q = quaternion_wxyz(X_WM.rotation);
    config.mount.look_at.reset(), config.mount.roll = 0;
    config.mount.rotation = {q[0], q[1], q[2], q[3]};
    config.mount.position = {X_WM.position.x(), X_WM.position.y(), X_WM.position.z()};
    for (int i = 0; i < 3; ++i) {
      config.head.tilt_axis[static_cast<std::size_t>(i)] += x[15 + i];
      config.head.pupil[static_cast<std::size_t>(i)] += x[18 + i];
    }
    config.head.pupil_shift += x[21];
    const StageState stage{stage_.offset + x.segment<3>(9)};
    const HeadState head{head_.pan + x[12], head_.tilt + x[13], head_.zoom + x[14]};
    return *Camera(config).view({head, stage}).project(p_WP_ + x.head<3>());
  }

 private:
  CameraConfig config_;
  StageState stage_;
  HeadState head_;
  Eigen::Vector3d p_WP_;
};

TEST(Camera, ItsDerivativesAreThoseOfItsPixels) {
  for_random_cases(150, [](TestRandom& random) {
    const CameraConfig config = random_camera(random);
    const Camera camera(config);
    HeadState head = random_head(random, camera);
    if (const auto& rows = config.lens.zoom; !rows.empty()) {
      // Away from the rows, where the second derivative jumps.
      const double a = rows[0].count.value_or(rows[0].ratio), b = rows[1].count.value_or(rows[1].ratio);
      head.zoom = 0.5 * (a + b);
    }
    const StageState stage = random_stage(random, camera);
    const Eigen::Vector3d p_CP =
        random.uniform(1, 3) * Eigen::Vector3d(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 1);
    const Eigen::Vector3d p_WP = camera.pose({head, stage}) * p_CP;
    const EveryParameter parameters(config, stage, head, p_WP);
    const auto projection = camera.project(p_WP, {head, stage});
    ASSERT_TRUE(projection);
    Eigen::Matrix<double, 2, EveryParameter::count> analytic;
    analytic << projection->by_point, projection->by_mount, projection->by_stage, projection->by_pan,
        projection->by_tilt, projection->by_zoom, projection->by_tilt_axis, projection->by_pupil,
        projection->by_pupil_shift;
    const NumericalJacobian numeric =
        numerical_jacobian([&](const Eigen::VectorXd& x) { return parameters.pixel(x); },
                           Eigen::VectorXd::Zero(EveryParameter::count), 0.02);
    const double f = camera.lens().at(head.zoom).fx;
    for (int i = 0; i < EveryParameter::count; ++i)
      EXPECT_LE((analytic.col(i) - numeric.value.col(i)).norm(), 1e-8 * f) << "parameter " << i;
  });
}

TEST(Camera, ItsDerivativeByTheLensIsThatAtThisZoom) {
  for_random_cases(50, [](TestRandom& random) {
    const Camera camera(random_camera(random));
    const HeadState head = random_head(random, camera);
    const StageState stage = random_stage(random, camera);
    const Eigen::Vector3d p_CP(0.2, -0.1, 1.5);
    const auto projection = camera.project(camera.pose({head, stage}) * p_CP, {head, stage});
    ASSERT_TRUE(projection);
    const auto expected = *camera.view({head, stage}).lens.project_with_derivatives(p_CP);
    EXPECT_LE((projection->by_intrinsics - expected.by_intrinsics).norm(),
              1e-9 * expected.by_intrinsics.norm());
  });
}

TEST(Camera, ItsDerivativeByTheLensAtRatioOneIsThatOfItsPixels) {
  for_random_cases(50, [](TestRandom& random) {
    CameraConfig config = random_camera(random);
    for (ZoomRow& row : config.lens.zoom) row.fx.reset(), row.distortion.reset();
    const Camera camera(config);
    const HeadState head = random_head(random, camera);
    const StageState stage = random_stage(random, camera);
    const Eigen::Vector3d p_WP = camera.pose({head, stage}) * Eigen::Vector3d(0.2, -0.1, 1.5);
    const auto projection = camera.project(p_WP, {head, stage});
    ASSERT_TRUE(projection);
    const auto pixel = [&](double fx, double k1) {
      CameraConfig changed = config;
      changed.lens.fx += fx, changed.lens.distortion[0] += k1;
      return *Camera(changed).view({head, stage}).project(p_WP);
    };
    const Eigen::Vector2d by_fx = (pixel(1e-3, 0) - pixel(-1e-3, 0)) / 2e-3;
    const Eigen::Vector2d by_k1 = (pixel(0, 1e-5) - pixel(0, -1e-5)) / 2e-5;
    EXPECT_LE((projection->by_lens.col(0) - by_fx).norm(), 1e-6);
    EXPECT_LE((projection->by_lens.col(4) - by_k1).norm(), 1e-6 * camera.lens().at(head.zoom).fx);
  });
}

TEST(Camera, OutsideItsZoomHasNoView) {
  CameraConfig config = cameras_at({5, 5})[0];
  config.lens.zoom = sony_zoom();
  const Camera camera(config);
  EXPECT_EQ(camera.head_axes()[2].limits[1], 0x4000);
  EXPECT_EQ(camera.initial_head().zoom, 0);
  EXPECT_THROW((void)camera.view({{0, 0, -5}, {}}), std::out_of_range);
  EXPECT_THROW((void)camera.project({0, 0, 0}, {{0, 0, 20000}, {}}), std::out_of_range);
}

}  // namespace
}  // namespace flexura
