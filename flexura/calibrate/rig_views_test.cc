#include "flexura/calibrate/rig_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/calibrate/rig_aim.h"
#include "tests/support/random_cases.h"
#include "tests/support/rig_figures.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

ArmState bent(double x, double y) {
  ArmState state = ArmState::straight(3);
  for (Eigen::Vector2d& bend : state.bends) bend = {x, y};
  return state;
}

std::vector<ViewGoal> goals_of(const RigProblem& problem, const RigCalibration& found) {
  const RigVariables& variables = problem.variables();
  const OpticalAxis a = optical_axis(variables, found.x, {{0, {}, {}}, {}}),
                    b = optical_axis(variables, found.x, {{1, {}, {}}, {}});
  return {{axes_angle(a, b), 0.01 * degree}, {log_focal(a), 0.003}, {log_focal(b), 0.003}};
}

TEST(NextBestView, PredictsThePicture) {
  TestRandom random(5);
  RigTrialConfig config;
  RigTrial trial(true_rig(nominal_rig(), config, random), config, random);
  take_plan(trial, 3);
  RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
  const RigCalibration found = calibrate_rig(problem);
  const std::vector<ViewCandidate> candidates =
      view_candidates(found.model, {.poses = {bent(0.5, 0), bent(0, 0.7), bent(-0.5, 0.4)},
                                    .zooms = {1, 2},
                                    .slides = {{0, 0, 0}, {0.2, 0, 0}}});
  ASSERT_EQ(candidates.size(), 60U);
  ViewConfig views;
  views.points = config.points;
  const auto goals = goals_of(problem, found);
  const auto choice = next_best_view(problem, found, candidates, goals, views);
  ASSERT_TRUE(choice);
  for (const ViewCandidate& candidate : candidates)
    if (const auto alone = next_best_view(problem, found, {&candidate, 1}, goals, views)) {
      EXPECT_GE(alone->after, choice->after);
    }

  const ViewCandidate& next = candidates[choice->candidate];
  const std::size_t pose = trial.add_pose(next.pose);
  for (const RigStance& stance : next.stances) trial.add_image(trial.add_stance(stance), pose);
  RigProblem after(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
  const RigCalibration better = calibrate_rig(after);
  const auto reached = goals_of(after, better);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const double sigma = reached[i].quantity.sigma(better.covariance);
    EXPECT_NEAR(sigma / choice->sigmas[i], 1, 0.25) << reached[i].quantity.name;
  }
}

TEST(NextBestView, HasNoneWhereTheArmIsOutOfView) {
  TestRandom random(8);
  RigTrial trial(true_rig(nominal_rig(), {}, random), {}, random);
  take_plan(trial, 2);
  RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
  const RigCalibration found = calibrate_rig(problem);
  const std::vector<ViewCandidate> away = {{bent(0, 0), {{0, {1.5, 0, 1}, {}}, {1, {0, 0, 1}, {}}}}};
  EXPECT_FALSE(next_best_view(problem, found, away, goals_of(problem, found)));
}

}  // namespace
}  // namespace flexura
