#include "flexura/calibrate/rig_calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "flexura/calibrate/rig_observability.h"
#include "tests/support/random_cases.h"
#include "tests/support/rig_figures.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

RigTrial planned_trial(const RigTrialConfig& config, TestRandom& random, std::size_t pictures = 12) {
  RigTrial trial(true_rig(nominal_rig(), config, random), config, random);
  take_plan(trial, pictures);
  return trial;
}

// A prior that holds everything; tests free what they name.
RigPrior all_held(const RigModel& model) {
  RigPrior prior = rough_prior(model);
  prior.arm = {.length = 0, .bend_gain = 0, .bend_share = 0, .bend = 0};
  for (CameraPrior& camera : prior.cameras)
    camera = {.position = 0,
              .rotation = 0,
              .pan_zero = 0,
              .tilt_zero = 0,
              .tilt_axis = 0,
              .pupil = 0,
              .pupil_shift = 0,
              .focal = 0,
              .aspect = 0,
              .principal_point = 0,
              .distortion = {},
              .zoom_row = 0,
              .steps = 0};
  return prior;
}

TEST(RigCalibration, ConvergesFromRoughGuessesAndKnowsHowWell) {
  double sum = 0;
  int count = 0;
  for_random_cases(40, [&](TestRandom& random) {
    const RigTrial trial = planned_trial({}, random);
    RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
    const RigCalibration found = calibrate_rig(problem);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LE(found.rms, 1.05);
    const RigFigures figures = figures_of(trial, problem, found);
    EXPECT_LE(std::abs(figures.angle.error), 0.4 * degree);
    EXPECT_LE(std::abs(figures.angle.error), 4 * figures.angle.sigma);
    for (const RigFigure& focal : figures.focal) EXPECT_LE(std::abs(focal.error), 0.01);
    for (const RigFigure& figure : {figures.angle, figures.zoom_ratio, figures.focal[0], figures.focal[1]}) {
      sum += std::pow(figure.error / figure.sigma, 2);
      ++count;
    }
  });
  RecordProperty("chi_square_share", std::to_string(sum / count));
  // The chi-square sum of many correlated variables is 0.79 times their count. The lower bound detects sigmas
  // that are too large by sqrt(2), which would halve it.
  EXPECT_GT(sum, (one_case_of > 1 ? 0.1 : 0.6) * count);
  EXPECT_LT(sum, (1 + 4 * std::sqrt(2.0 / count)) * count);
}

TEST(RigCalibration, SolvesMinimalCasesExactly) {
  // One camera with unknown position and rotation. Three markers of one pose give six equations for six
  // unknowns, with up to four solutions; the one near the guess is found. A fourth marker makes it unique.
  for_random_cases(20, [](TestRandom& random) {
    for (const std::size_t markers : {std::size_t{3}, std::size_t{4}}) {
      RigTrialConfig config;
      config.are_heads_exact = true, config.noise = 0, config.markers = markers, config.points = 0;
      config.focal = config.principal_point = config.bend = config.length = config.zero = 0;
      config.turn = 3 * degree, config.shift = 0.1;
      RigModel nominal = nominal_rig();
      nominal.cameras.resize(1);
      RigTrial trial(true_rig(nominal, config, random), config, random);
      take_plan(trial, 1);
      ASSERT_EQ(trial.seen().images[0].markers.size(), markers);
      RigPrior prior = all_held(nominal);
      prior.cameras[0].position = prior.cameras[0].rotation = unknown;
      RigProblem problem(nominal, prior, trial.seen());
      ASSERT_EQ(problem.variables().count(), 6);
      const RigCalibration found = calibrate_rig(problem);
      ASSERT_TRUE(found.is_found) << found.reason;
      EXPECT_LE(found.rms, 1e-6);
      if (markers == 3) continue;
      const Pose is = found.model.cameras[0].mount.pose(), should = trial.truth().cameras[0].mount.pose();
      EXPECT_LE((is.position - should.position).norm(), 1e-7);
      EXPECT_LE((is.rotation - should.rotation).norm(), 1e-7);
    }
  });
}

TEST(RigCalibration, FindsEverythingWithoutNoise) {
  for_random_cases(3, [](TestRandom& random) {
    RigTrialConfig config;
    config.are_heads_exact = true, config.noise = 0, config.points = 0;
    config.length = 0;  // Otherwise the overall scale is free.
    RigTrial trial(true_rig(nominal_rig(), config, random), config, random);
    take_plan(trial);
    RigPrior prior = all_held(nominal_rig());
    prior.arm.bend_gain = unknown;
    for (CameraPrior& camera : prior.cameras)
      camera.position = camera.rotation = camera.tilt_zero = camera.focal = camera.principal_point = unknown;
    RigProblem problem(nominal_rig(), prior, trial.seen());
    const RigCalibration found = calibrate_rig(problem);
    ASSERT_TRUE(found.is_found) << found.reason;
    const RigFigures figures = figures_of(trial, problem, found);
    EXPECT_LE(std::abs(figures.angle.error), 1e-8);
    EXPECT_LE(std::abs(figures.focal[0].error), 1e-8);
    EXPECT_LE(figures.aim, 1e-8);
  });
}

// One row of one camera's zoom table has a focal length wrong by 1 %.
TEST(RigCalibration, FindsTheRowOfAZoomTableThatIsWrong) {
  for_random_cases(4, [](TestRandom& random) {
    RigModel nominal = nominal_rig();
    for (CameraConfig& camera : nominal.cameras)
      for (const double ratio : {1.0, 1.5, 2.0}) camera.lens.zoom.emplace_back().ratio = ratio;
    RigTrialConfig config;
    config.focal = 0;
    RigModel truth = true_rig(nominal, config, random);
    const std::size_t wrong = random.integer(0, 1) == 1 ? 1 : 0;
    const double off = random.integer(0, 1) == 1 ? 0.01 : -0.01;
    LensConfig& lens = truth.cameras[wrong].lens;
    lens.zoom[1].fx = lens.zoom[1].fy = lens.fx * 1.5 * (1 + off);
    RigTrial trial(truth, config, random);
    take_plan(trial);
    RigPrior prior = rough_prior(nominal);
    for (CameraPrior& camera : prior.cameras) camera.focal = 0;
    RigProblem problem(nominal, prior, trial.seen());
    const RigCalibration found = calibrate_rig(problem);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LE(found.rms, 1.05);
    const RigVariables& variables = problem.variables();
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Index rows = variables.column(variables.camera_slots(i) + zoom_row_slot);
      // Difference of the second row's focal length from the first one's.
      const double sigma = std::sqrt(found.covariance(rows, rows) + found.covariance(rows + 1, rows + 1) -
                                     2 * found.covariance(rows, rows + 1));
      EXPECT_LE(sigma, 0.002);
      EXPECT_LE(std::abs(found.x[rows + 1] - found.x[rows] - (i == wrong ? std::log(1 + off) : 0)),
                4 * sigma);
      // Nothing was observed at the last row's zoom.
      EXPECT_NEAR(std::sqrt(found.covariance(rows + 2, rows + 2)), prior.cameras[i].zoom_row, 1e-3);
    }
  });
}

TEST(RigCalibration, LeavesOutWhatIsNotTheArm) {
  for_random_cases(2, [](TestRandom& random) {
    RigTrial trial = planned_trial({}, random);
    std::vector<RigOutlier> wrong;
    for (std::size_t i = 0; i < trial.seen().images.size(); i += 2) {
      trial.change_seen().images[i].markers[2].pixel += Eigen::Vector2d(30, -20);
      wrong.push_back({i, 2});
    }
    RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
    const RigCalibration found = calibrate_rig(problem);
    ASSERT_TRUE(found.is_found) << found.reason;
    for (const RigOutlier& outlier : wrong)
      EXPECT_NE(std::ranges::find(found.outliers, outlier), found.outliers.end());
    EXPECT_LE(found.outliers.size(), wrong.size() + 3);
    EXPECT_LE(found.rms, 1.05);
  });
}

TEST(RigCalibration, IsNoneWhereNothingWasSeen) {
  const RigModel nominal = nominal_rig();
  RigProblem problem(nominal, rough_prior(nominal), {});
  const RigCalibration none = calibrate_rig(problem);
  EXPECT_FALSE(none.is_found);
  EXPECT_EQ(none.reason, "there are no observations");
}

TEST(RigCalibration, SaysWhyWhenNothingFits) {
  for_random_cases(1, [](TestRandom& random) {
    RigTrial trial = planned_trial({}, random, 3);
    for (RigImage& image : trial.change_seen().images)
      for (SeenMarker& marker : image.markers) marker.pixel = random.vector<2>(0, 480);
    for (RigImage& image : trial.change_seen().images) image.points.clear();
    RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
    const RigCalibration found = calibrate_rig(problem);
    EXPECT_FALSE(found.is_found);
    EXPECT_FALSE(found.reason.empty());
    EXPECT_EQ(found.starts, 7);
  });
}

TEST(RigCalibration, IsTheSameWhereverTheWorldIsCountedFrom) {
  for_random_cases(1, [](TestRandom& random) {
    const RigTrial trial = planned_trial({}, random);
    const RigModel here = nominal_rig();
    const Pose X_VW{so3_exp({0.3, -1.0, 0.4}), {3, -2, 5}};
    RigModel there = here;
    there.arm.X_WB = X_VW * here.arm.X_WB;
    for (CameraConfig& camera : there.cameras) {
      const Pose X_VM = X_VW * camera.mount.pose();
      const Eigen::Vector4d q = quaternion_wxyz(X_VM.rotation);
      for (std::size_t i = 0; i < 3; ++i)
        camera.mount.position[i] = X_VM.position[static_cast<Eigen::Index>(i)];
      camera.mount.look_at.reset(), camera.mount.rotation = {q[0], q[1], q[2], q[3]};
    }
    RigProblem problem(here, rough_prior(here), trial.seen()), moved(there, rough_prior(there), trial.seen());
    const RigCalibration a = calibrate_rig(problem), b = calibrate_rig(moved);
    const auto angle = [](const RigProblem& in, const RigCalibration& found) {
      return axes_angle(optical_axis(in.variables(), found.x, observed_stance(in.variables(), 0)),
                        optical_axis(in.variables(), found.x, observed_stance(in.variables(), 1)));
    };
    EXPECT_NEAR(angle(problem, a).value, angle(moved, b).value, 1e-6);
    EXPECT_NEAR(angle(problem, a).sigma(a.covariance) / angle(moved, b).sigma(b.covariance), 1, 1e-4);
    EXPECT_NEAR(a.rms, b.rms, 1e-6);
  });
}

TEST(RigCalibration, GivesTheSameBitsInEveryThread) {
  TestRandom random(7);
  const RigTrial trial = planned_trial({}, random, 6);
  std::vector<Eigen::VectorXd> answers(4);
  std::vector<std::thread> threads;
  threads.reserve(answers.size());
  for (Eigen::VectorXd& answer : answers)
    threads.emplace_back([&] {
      RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
      answer = calibrate_rig(problem).x;
    });
  for (std::thread& thread : threads) thread.join();
  for (const Eigen::VectorXd& answer : answers) EXPECT_EQ(answer, answers.front());
}

TEST(RigObservability, SaysWhatThePicturesDoNotTell) {
  TestRandom random(3);
  const RigTrial trial = planned_trial({}, random);
  RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
  const RigObservability determined = observability(problem.variables(), calibrate_rig(problem).covariance);
  const auto find = [&](const std::string& name) {
    const auto found = std::ranges::find(determined.numbers, name, &RigKnowledge::name);
    EXPECT_NE(found, determined.numbers.end()) << name;
    return *found;
  };
  EXPECT_TRUE(find("front: focal length").is_determined);
  EXPECT_TRUE(find("side: mount's rotation, y").is_determined);
  // Along the tilt axis, shifts of pupil and axis are indistinguishable.
  EXPECT_FALSE(find("front: pupil, x").is_determined);
  EXPECT_FALSE(find("front: tilt axis, x").is_determined);
  ASSERT_FALSE(determined.unobservable.empty());
  EXPECT_GE(determined.unobservable.front().share, 0.99);
  EXPECT_LE(determined.unobservable.front().share, 1 + 1e-6);
  for (std::size_t i = 1; i < determined.unobservable.size(); ++i)
    EXPECT_LE(determined.unobservable[i].share, determined.unobservable[i - 1].share);
}

TEST(RigCalibration, LearnsThePrincipalPointFromZoomingWithoutATurn) {
  TestRandom random(4);
  RigTrial trial(true_rig(nominal_rig(), {}, random), {}, random);
  take_plan(trial, 3);
  for (std::size_t camera = 0; camera < 2; ++camera) {
    RigStance stance = trial.seen().stances[camera];
    stance.head.zoom = 2, stance.turned_as = camera;
    trial.add_image(trial.add_stance(stance), 0);
  }
  const auto sigma = [](const RigObservations& seen) {
    RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), seen);
    const RigCalibration found = calibrate_rig(problem);
    EXPECT_TRUE(found.is_found) << found.reason;
    const std::size_t slot = problem.variables().camera_slots(0) + principal_point_slot;
    const Eigen::Index column = problem.variables().column(slot);
    return std::sqrt(found.covariance(column, column));
  };
  RigObservations apart = trial.seen();
  for (RigStance& stance : apart.stances) stance.turned_as.reset();
  EXPECT_LT(sigma(trial.seen()), 0.7 * sigma(apart));
}

TEST(RigProblem, IsNoneWhereALensIsNone) {
  TestRandom random(9);
  const RigTrial trial = planned_trial({}, random, 1);
  RigModel nominal = nominal_rig();
  for (const double ratio : {1.0, 1.05, 3.0})
    nominal.cameras[0].lens.zoom.push_back(
        {.ratio = ratio, .count = {}, .fx = {}, .fy = {}, .cx = {}, .cy = {}, .distortion = {}});
  RigProblem problem(nominal, rough_prior(nominal), trial.seen());
  const RigVariables& variables = problem.variables();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(variables.count());
  EXPECT_TRUE(problem.linearise(x));
  const Eigen::Index second = variables.column(variables.camera_slots(0) + zoom_row_slot + 1);
  x[second] = -0.1;  // Below the first row's.
  EXPECT_FALSE(problem.linearise(x));
  x[second] = 1e9;
  EXPECT_FALSE(problem.linearise(x));
}

TEST(RigProblem, RefusesWhatDoesNotFit) {
  const RigModel model = nominal_rig();
  RigPrior prior = rough_prior(model);
  RigObservations seen;
  seen.poses = {ArmState::straight(2)};
  EXPECT_THROW(RigProblem(model, prior, seen), std::invalid_argument);
  seen.poses = {ArmState::straight(3)}, seen.stances = {{2, {}, {}}};
  EXPECT_THROW(RigProblem(model, prior, seen), std::invalid_argument);
  seen.stances = {{1, {}, {}}}, seen.images = {{.stance = 1}};
  EXPECT_THROW(RigProblem(model, prior, seen), std::invalid_argument);
  seen.images = {{.stance = 0, .markers = {{{0, 0}, 1.5}}}};
  EXPECT_THROW(RigProblem(model, prior, seen), std::out_of_range);
  seen.images.clear();
  seen.stances[0].turned_as = 0;
  EXPECT_THROW(RigProblem(model, prior, seen), std::invalid_argument);
  seen.stances[0].turned_as.reset();
  EXPECT_NO_THROW(RigProblem(model, prior, seen));
  prior.cameras[0].focal = -1;
  EXPECT_THROW(RigProblem(model, prior, seen), std::invalid_argument);
  prior.cameras.pop_back();
  EXPECT_THROW(RigProblem(model, prior, seen), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
