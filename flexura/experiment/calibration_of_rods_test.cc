// Calibration of cameras by an arm of elastic rods that differs from its model.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_calibration.h"
#include "flexura/experiment/experiment.h"
#include "flexura/tasks/calibrate/calibrate_config.h"
#include "tests/support/random_cases.h"
#include "tests/support/rig_figures.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

// The arm of nominal_rig as three NiTi wires, pulled by nine tendons. `world`: keys of the tables `arm` and
// `arm.tendon` of the truth that differ from the model.
struct RodWorld {
  double stiffness = 1, mass = 1;  // Over the model's.
  double compliance = 0;           // Of the tendons, m/N.
  double friction = 0;             // Of the tendons.
};

ArmModel rods(const RodWorld& world) {
  std::string text = "[arm]\nkind = \"spatial\"\nmodel = \"static\"\ngravity = [0, -9.81, 0]\n", tendons,
              axes;
  for (const Section& section : three_section_arm().sections)
    text += fmt::format(
        "[[arm.section]]\nlength = {}\nradius = 0.02\nbend_profile = [1]\nmaterial = {{ youngs_modulus = {}, "
        "radius_mm = 1.7, "
        "mass_per_length = {} }}\n",
        section.length, world.stiffness * 54e9, world.mass * 0.15);
  for (int i = 0; i < 9; ++i) {
    const std::string tendon =
        fmt::format("section = {}, angle_deg = {}", i / 3 + 1, 120 * (i % 3) + 40 * (i / 3));
    tendons += fmt::format("  {{ {}, radius_mm = 15, compliance = {}, friction = {} }},\n", tendon,
                           world.compliance, world.friction);
    axes += fmt::format("  {{ {} }},\n", tendon);
  }
  text = text.insert(text.find("[[arm.section]]"), fmt::format("tendon = [\n{}]\n", tendons));
  text += fmt::format("[drive]\nradius_mm = 15\npretension = 10\ntendon = [\n{}]\n", axes);
  return parse_experiment(text + "[[task]]\nkind = \"hold\"\nduration = 1\n", "x.toml").arm_model();
}

// Errors of a calibration in units of their stated standard deviations: angle between the axes, focal
// lengths, zoom ratio, and directions of both axes in W.
std::vector<double> errors_of(const RigTrial& trial, const RigPrior& prior) {
  RigProblem problem(rig_model(rods({}), nominal_rig().cameras), prior, trial.seen());
  const RigCalibration found = calibrate_rig(problem);
  EXPECT_TRUE(found.is_found) << found.reason;
  const RigFigures figures = figures_of(trial, problem, found);
  std::vector<double> errors;
  for (const RigFigure& figure : {figures.angle, figures.focal[0], figures.focal[1], figures.zoom_ratio})
    errors.push_back(figure.error / figure.sigma);
  for (std::size_t i = 0; i < 2; ++i) {
    const OpticalAxis axis =
        optical_axis(problem.variables(), found.x, observed_stance(problem.variables(), i));
    const Eigen::Vector3d off = axis.direction - view_of(trial.truth(), trial.stance(i)).X_WC.rotation.col(2);
    for (const Eigen::Index across : {0, 1}) {
      const Eigen::Vector3d way = axis.R_WC.col(across);
      const Eigen::VectorXd slope = axis.direction_by_x.transpose() * way;
      errors.push_back(way.dot(off) / std::sqrt(slope.dot(found.covariance * slope)));
    }
  }
  return errors;
}

// Without the errors of the response, a wrong arm turns the cameras further than their stated uncertainty.
TEST(CalibrationOfRods, KnowsItsErrorsThoughTheArmDiffersFromItsModel) {
  const RigModel nominal = rig_model(rods({}), nominal_rig().cameras),
                 stiffer = rig_model(
                     rods({.stiffness = 1.2, .mass = 1.3, .compliance = 3e-5, .friction = 0.02}), {});
  RigPrior usual = rough_prior(nominal), wide = usual;
  wide.arm.response = 0.2, wide.arm.pose_response = 0.05;
  double with = 0, without = 0, most = 0, count = 0;
  for_random_cases(3, [&](TestRandom& random) {
    RigTrialConfig config;
    config.bend = 0;
    RigModel truth = true_rig(nominal, config, random);
    truth.actuation = stiffer.actuation;
    RigTrial trial(truth, config, random);
    take_plan(trial);
    for (const double error : errors_of(trial, wide))
      with += error * error, most = std::max(most, std::abs(error)), ++count;
    for (const double error : errors_of(trial, usual)) without += error * error;
  });
  EXPECT_LT(with, 2 * count);
  EXPECT_LT(most, 4);
  EXPECT_GT(without, 4 * count);
}

// With an arm like its model, errors of the response do no harm.
TEST(CalibrationOfRods, IsAsGoodIfTheArmIsLikeItsModel) {
  const RigModel nominal = rig_model(rods({}), nominal_rig().cameras);
  RigPrior wide = rough_prior(nominal);
  wide.arm.response = 0.2, wide.arm.pose_response = 0.05;
  double sum = 0, count = 0;
  for_random_cases(2, [&](TestRandom& random) {
    RigTrial trial(true_rig(nominal, {}, random), {}, random);
    take_plan(trial);
    for (const double error : errors_of(trial, wide)) sum += error * error, ++count;
  });
  EXPECT_LT(sum, 2 * count);
}

TEST(CalibrationOfRods, AreDoubtedUnlessTheFileSaysOtherwise) {
  const RigModel stiff = nominal_rig(), elastic = rig_model(rods({}), stiff.cameras);
  CalibrateTask task;
  EXPECT_EQ(session_prior(task, stiff, {}).arm.response, 0);
  EXPECT_EQ(session_prior(task, elastic, {}).arm.response, 0.2);
  EXPECT_EQ(session_prior(task, elastic, {}).arm.pose_response, 0.05);
  task.arm_prior = {.length_std = 0.001, .response_std = 0.1, .pose_response_std = 0};
  for (const RigModel& model : {stiff, elastic}) {
    const ArmPrior prior = session_prior(task, model, {}).arm;
    EXPECT_EQ(prior.length, 0.001);
    EXPECT_EQ(prior.response, 0.1);
    EXPECT_EQ(prior.pose_response, 0);
  }
}

}  // namespace
}  // namespace flexura
