#include "flexura/calibrate/arcs_loop.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>

#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_quantities.h"
#include "flexura/model/backbone.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

TEST(ArcState, IsOneArcOfACircleInItsPlaneWhereTheArmCan) {
  Arm arm = nominal_rig().arm;
  arm.sections[2].length *= 0.8;
  for (Section& section : arm.sections) section.max_bend = 2;
  for_random_cases(100, [&](TestRandom& random) {
    const double bend = random.uniform(0.3, 4), way = random.uniform(-3, 3);
    const Eigen::Vector3d towards(std::cos(way), 0, std::sin(way));
    const auto state = arc_state(arm, bend, towards);
    ASSERT_TRUE(state);
    const Backbone backbone(arm, *state);
    const double radius = arm.length() / bend;
    for (int i = 0; i <= 20; ++i) {
      const Eigen::Vector3d p = backbone.pose(arm.length() * i / 20).position - arm.X_WB.position;
      EXPECT_NEAR((p - radius * towards).norm(), radius, 1e-12);
      EXPECT_NEAR(p.dot(towards.cross(Eigen::Vector3d::UnitY())), 0, 1e-12);
    }
  });
  EXPECT_FALSE(arc_state(arm, 6.4, Eigen::Vector3d::UnitX()));  // A section bends by 2 rad at most.
  EXPECT_FALSE(arc_state(arm, 1, Eigen::Vector3d::UnitY()));
  arm.kind = ArmKind::planar;
  EXPECT_TRUE(arc_state(arm, 1, Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(arc_state(arm, 1, Eigen::Vector3d::UnitZ()));
}

constexpr RigTrialConfig known_lenses = {
    .zero = 0, .focal = 0, .principal_point = 1, .noise = 0.2, .markers = 12};

// What both cameras see of both arcs from their starting positions, for a rig with errors from arcs_prior.
RigObservations arcs_seen(const RigModel& truth, TestRandom& random) {
  RigTrial trial(truth, known_lenses, random);
  for (const Eigen::Vector3d& towards : {Eigen::Vector3d::UnitX().eval(), (-Eigen::Vector3d::UnitZ()).eval()})
    (void)trial.add_pose(arc_state(nominal_rig().arm, 2 * std::numbers::pi / 3, towards).value());
  for (const std::size_t camera : {std::size_t{0}, std::size_t{1}}) {
    const std::size_t stance = trial.add_stance({.camera = camera});
    for (const std::size_t pose : {std::size_t{0}, std::size_t{1}}) (void)trial.add_image(stance, pose);
  }
  return trial.seen();
}

TEST(ArcsPrior, MakesTwoArcsTellTheAngleBetweenTheAxesAsWellAsItSays) {
  double squares = 0, largest = 0;
  int count = 0;
  for_random_cases(30, [&](TestRandom& random) {
    const RigModel truth = true_rig(nominal_rig(), known_lenses, random);
    RigProblem problem(nominal_rig(), arcs_prior(rough_prior(nominal_rig())), arcs_seen(truth, random));
    const RigCalibration found = calibrate_rig(problem);
    ASSERT_TRUE(found.is_found) << found.reason;
    const RigVariables& variables = problem.variables();
    const RigQuantity angle = axes_angle(optical_axis(variables, found.x, {{.camera = 0}, {}}),
                                         optical_axis(variables, found.x, {{.camera = 1}, {}}));
    const auto direction = [&](std::size_t camera) {
      return view_of(truth, {.camera = camera}).X_WC.rotation.col(2).eval();
    };
    const double sigma = angle.sigma(found.covariance);
    const double off = (angle.value - std::acos(direction(0).dot(direction(1)))) / sigma;
    squares += off * off, ++count, largest = std::max(largest, sigma);
    EXPECT_LT(std::abs(off), 5);
  });
  // The errors are uniform within one prior standard deviation, hence smaller than normal ones.
  EXPECT_LT(std::sqrt(squares / count), 1.2);
  EXPECT_GT(std::sqrt(squares / count), 0.3);
  EXPECT_LT(largest, 0.4 * degree);
}

}  // namespace
}  // namespace flexura
