#include "flexura/calibrate/rig_rows.h"

#include <gtest/gtest.h>

#include "flexura/calibrate/rig_problem.h"
#include "flexura/calibrate/rig_quantities.h"
#include "flexura/math/derivative_check.h"
#include "tests/support/cameras.h"
#include "tests/support/random_cases.h"
#include "tests/support/rig_figures.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

// A rig with errors in all variables, and two pictures by cameras of which one has a zoom table.
struct Everything {
  RigModel model;
  RigPrior prior;
  RigObservations seen;
};

Everything random_everything(TestRandom& random) {
  Everything all;
  std::vector<CameraConfig> cameras = cameras_at({2.5, 2.5}, {0, 0.5, 0});
  for (CameraConfig& camera : cameras) {
    const CameraConfig other = random_camera(random);
    camera.head = other.head, camera.lens = other.lens, camera.mount.stage = other.mount.stage;
    camera.head.pan.resolution = camera.head.tilt.resolution = camera.head.zoom.resolution = 0.01;
    for (SlideConfig* slide : {&camera.mount.stage.x, &camera.mount.stage.y, &camera.mount.stage.z})
      slide->resolution = 0.01;
  }
  Arm arm = three_section_arm();
  const bool has_arcs = random.integer(0, 1) == 1;
  if (has_arcs) arm.sections[1].bend_profile = {1.0, 2.0, 1.0};
  all.model = rig_model(arm, cameras);
  all.prior = rough_prior(all.model);
  all.prior.arm.response = 0.2, all.prior.arm.pose_response = 0.05;
  for (CameraPrior& prior : all.prior.cameras)
    prior.pan_zero = 0.01, prior.distortion = {0.02, 0.01, 0.001, 0.001, 0.01};
  all.seen.poses = {random_bends(random, arm, 0.8)};
  for (std::size_t i = 0; i < 2; ++i) {
    const ZoomTable lens(cameras[i].lens, 640, 480);
    const double zoom = lens.is_linear() ? 1.3 : 0.6 * lens.first() + 0.4 * lens.last();
    all.seen.stances.push_back(
        {i, {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), zoom}, {random.vector<3>(-0.1, 0.1)}});
    RigImage& image = all.seen.images.emplace_back(RigImage{.stance = i});
    for (const double s : {0.0, 0.21, 1.0 / 3, 0.7, 1.0})
      image.markers.push_back({random.vector<2>(200, 300), s, 0.5});
  }
  return all;
}

TEST(RigRows, DerivativesByEveryNumberAreThoseOfDifferences) {
  for_random_cases(4, [](TestRandom& random) {
    const Everything all = random_everything(random);
    RigProblem problem(all.model, all.prior, all.seen);
    const RigVariables& variables = problem.variables();
    Eigen::VectorXd x(variables.count());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x[i] = variables.variable(i).scale * random.uniform(-0.5, 0.5);
    ASSERT_TRUE(problem.linearise(x));
    for (std::size_t image = 0; image < 2; ++image) {
      const RigRows rows = problem.rows()[image];
      const NumericalJacobian numerical = row_differences(problem, x, image, 3e-4);
      for (Eigen::Index j = 0; j < rows.derivatives.cols(); ++j) {
        const double size = std::max(1.0, rows.derivatives.col(j).norm());
        EXPECT_LE((numerical.value.col(j) - rows.derivatives.col(j)).norm(), 1e-6 * size)
            << variables.variable(rows.columns[static_cast<std::size_t>(j)]).name;
      }
    }
  });
}

TEST(RigRows, AxisPointsFollowTheCurveAsItMoves) {
  for_random_cases(3, [](TestRandom& random) {
    RigTrialConfig config;
    config.markers = 2;
    RigTrial trial(true_rig(nominal_rig(), config, random), config, random);
    take_plan(trial, 2);
    RigModel model = trial.truth();
    model.arm = nominal_rig().arm;
    RigProblem problem(model, rough_prior(model), trial.seen());
    const Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.variables().count());
    ASSERT_TRUE(problem.linearise(x));
    const RigRows rows = problem.rows()[1];
    ASSERT_GT(rows.residuals.size(), 20);
    const NumericalJacobian numerical = row_differences(problem, x, 1, 1e-4);
    // The normals of the piecewise cubic curve turn slightly differently from those of the true curve. Points
    // beyond its end have no residual along it.
    EXPECT_LE((numerical.value - rows.derivatives).norm(), 1e-2 * rows.derivatives.norm());
  });
}

TEST(RigQuantities, DerivativesAreThoseOfDifferences) {
  for_random_cases(4, [](TestRandom& random) {
    const Everything all = random_everything(random);
    const RigVariables variables(all.model, all.prior, all.seen);
    Eigen::VectorXd x(variables.count());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x[i] = variables.variable(i).scale * random.uniform(-0.5, 0.5);
    const Eigen::Vector3d middle(0.1, 0.5, 0);
    const auto quantities = [&](const Eigen::VectorXd& at) {
      const OpticalAxis a = optical_axis(variables, at, observed_stance(variables, 0)),
                        b = optical_axis(variables, at, observed_stance(variables, 1));
      return std::vector<RigQuantity>{axes_angle(a, b), log_zoom_ratio(a, b, middle), log_focal(a),
                                      log_focal(b)};
    };
    const auto values = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
      Eigen::VectorXd result(4);
      for (Eigen::Index i = 0; i < 4; ++i) result[i] = quantities(at)[static_cast<std::size_t>(i)].value;
      return result;
    };
    const auto numerical = numerical_jacobian(values, x, 1e-3);
    for (Eigen::Index i = 0; i < 4; ++i)
      EXPECT_LE(
          (numerical.value.row(i).transpose() - quantities(x)[static_cast<std::size_t>(i)].gradient).norm(),
          1e-7);
    // The aim directions rotate with the camera; hence both derivatives agree only at the point itself.
    const OpticalAxis axis = optical_axis(variables, x, observed_stance(variables, 0));
    const Eigen::Vector3d on_axis = axis.pupil + 2 * axis.direction;
    const auto aims = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
      const auto [right, down] =
          aim_errors(optical_axis(variables, at, observed_stance(variables, 0)), on_axis);
      return Eigen::Vector2d(right.value, down.value);
    };
    const auto numerical_aims = numerical_jacobian(aims, x, 1e-3);
    const auto [right, down] = aim_errors(axis, on_axis);
    EXPECT_LE((numerical_aims.value.row(0).transpose() - right.gradient).norm(), 1e-7);
    EXPECT_LE((numerical_aims.value.row(1).transpose() - down.gradient).norm(), 1e-7);
  });
}

}  // namespace
}  // namespace flexura
