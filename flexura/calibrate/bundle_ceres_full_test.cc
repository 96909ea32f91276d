// Checks minimum and covariance against Ceres, with separately written residuals.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "flexura/base/degree.h"
#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_quantities.h"
#include "tests/support/ceres_peer.h"
#include "tests/support/random_cases.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

// Largest differences between two solutions.
struct Disagreement {
  double number = 0;      // Of any variable, in standard deviations.
  double angle = 0;       // Of the axis angle between two stances, rad.
  double focal = 0;       // Of focal lengths, relative.
  double place = 0;       // Of positions, m.
  double cost = 0;        // Of the cost, relative.
  double sigma = 0;       // Of any variable's standard deviation, relative.
  double covariance = 0;  // Of any entry, in units of the two variables' standard deviations.

  void widen(const Disagreement& other) {
    number = std::max(number, other.number), angle = std::max(angle, other.angle);
    focal = std::max(focal, other.focal), place = std::max(place, other.place);
    cost = std::max(cost, other.cost), sigma = std::max(sigma, other.sigma);
    covariance = std::max(covariance, other.covariance);
  }
};

void compare(const RigTrial& trial, double bound, Disagreement& worst) {
  const RigModel guess = nominal_rig();
  const RigPrior prior = rough_prior(guess);
  RigProblem problem(guess, prior, trial.seen());
  const RigCalibration found =
      calibrate_rig(problem, {.linear_beyond = bound, .outlier_beyond = std::max(8.0, 2 * bound)});
  ASSERT_TRUE(found.is_found) << found.reason;
  ASSERT_TRUE(found.outliers.empty());
  const CeresBundle peer = ceres_bundle(guess, prior, trial.seen(), bound);
  ASSERT_TRUE(peer.is_settled);
  ASSERT_EQ(peer.x.size(), found.x.size());
  const RigVariables& variables = problem.variables();
  const Eigen::MatrixXd covariance = found.covariance / (found.scale * found.scale);
  const Eigen::VectorXd sigmas = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd off = peer.x - found.x;
  Disagreement now;
  now.number = off.cwiseQuotient(sigmas).cwiseAbs().maxCoeff();
  now.cost = std::abs(problem.cost(bound) / peer.cost - 1);
  now.sigma =
      (peer.covariance.diagonal().cwiseSqrt().cwiseQuotient(sigmas).array() - 1).cwiseAbs().maxCoeff();
  now.covariance = (sigmas.cwiseInverse().asDiagonal() * (peer.covariance - covariance) *
                    sigmas.cwiseInverse().asDiagonal())
                       .cwiseAbs()
                       .maxCoeff();
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const std::size_t first = variables.camera_slots(camera);
    now.focal = std::max(now.focal, std::abs(off[variables.column(first + focal_slot)]));
    now.place = std::max(now.place, off.segment<3>(variables.column(first + mount_position_slot)).norm());
  }
  for (std::size_t i = 0; i + 1 < trial.seen().stances.size(); i += 2) {
    const RigQuantity angle = axes_angle(optical_axis(variables, found.x, observed_stance(variables, i)),
                                         optical_axis(variables, found.x, observed_stance(variables, i + 1)));
    now.angle = std::max(now.angle, std::abs(angle.value - std::acos(peer.axes[i].dot(peer.axes[i + 1]))));
  }
  worst.widen(now);
}

// Twelve pictures per camera, markers only.
Disagreement worst_of(int trials, double bound) {
  Disagreement worst;
  for_random_cases(trials, [&](TestRandom& random) {
    RigTrialConfig config;
    config.points = 0;
    RigTrial trial(true_rig(nominal_rig(), config, random), config, random);
    take_plan(trial);
    compare(trial, bound, worst);
  });
  std::printf("numbers %.2g sigma, angle %.2g deg, focal %.2g, place %.2g m, cost %.2g\n", worst.number,
              worst.angle / degree, worst.focal, worst.place, worst.cost);
  std::printf("sigmas %.2g, covariance %.2g\n", worst.sigma, worst.covariance);
  EXPECT_LT(worst.number, 1e-3);
  EXPECT_LT(worst.angle, 1e-5 * degree);
  EXPECT_LT(worst.focal, 1e-6);
  EXPECT_LT(worst.place, 1e-6);
  EXPECT_LT(worst.cost, 1e-9);
  return worst;
}

TEST(BundleByCeres, IsTheSameRigFromTheSameRoughGuessAndAsSureOfIt) {
  const Disagreement worst = worst_of(4, 8);  // No residual reaches this bound.
  EXPECT_LT(worst.sigma, 1e-5);
  EXPECT_LT(worst.covariance, 1e-5);
}

TEST(BundleByCeres, IsTheSameRigWhereResidualsAreBounded) { (void)worst_of(4, 3); }

}  // namespace
}  // namespace flexura
