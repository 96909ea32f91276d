#include "flexura/control/potential_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "flexura/control/lyapunov_monitor.h"
#include "tests/support/distributed_arms.h"

namespace flexura {
namespace {

using testing::Contains;
using testing::HasSubstr;

DistributedArm three_section_arm() {
  return DistributedArm({.lengths = {0.35, 0.35, 0.3},
                         .density = 0.5,
                         .bending_stiffness = 0.2,
                         .damping = 0.05,
                         .basis = AngleBasis::sections,
                         .points = 8});
}

Eigen::VectorXd evenly_bent(const DistributedArm& arm, double theta, double q) {
  return arm.coordinates([&](double s) { return Eigen::Vector2d(theta * s, q * s); });
}

TEST(PotentialRun, IsTheLawsOwnWhereMeasurementsAreExactAndMany) {
  const DistributedArm arm = three_section_arm();
  const PotentialLaw law(arm, evenly_bent(arm, 1.2, -0.6), {});
  PotentialRun exact(arm, law, evenly_bent(arm, 0, 0)),
      coarse(arm, law, evenly_bent(arm, 0, 0), {{.step = 0.02}}),
      fine(arm, law, evenly_bent(arm, 0, 0), {{.step = 0.002}});
  for (PotentialRun* run : {&exact, &coarse, &fine}) ASSERT_TRUE(run->advance(0.5));
  const double of_coarse = (coarse.motion().x() - exact.motion().x()).norm(),
               of_fine = (fine.motion().x() - exact.motion().x()).norm();
  EXPECT_GT(of_coarse, 1e-4);
  EXPECT_LT(of_fine, 0.15 * of_coarse);  // Of first order in the step.
}

TEST(PotentialRun, SeesLateWhatWas) {
  // x(t) = t^3 on each coordinate: the cubic between two moments is exact.
  MeasuredCoordinates measured({.step = 0.1, .delay = 0.25}, 1);
  for (int i = 0; i <= 10; ++i) {
    const double t = 0.1 * i;
    EXPECT_NEAR(measured.next(), t, 1e-15);
    measured.take(Eigen::VectorXd::Constant(2, t * t * t), Eigen::VectorXd::Constant(2, 3 * t * t));
    const double then = std::max(0.0, t - 0.25);
    EXPECT_NEAR(measured.seen()[0], then * then * then, 1e-12) << t;
  }
}

TEST(PotentialRun, NoiseHasItsDeviationAndIsIndependent) {
  MeasuredCoordinates measured({.noise = {0.1, 0.02}, .seed = 3}, 2);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(4);
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    measured.take(still, still);
    covariance += measured.seen() * measured.seen().transpose() / count;
  }
  const Eigen::Vector4d sigma(0.1, 0.1, 0.02, 0.02);
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(covariance(i, k) / (sigma[i] * sigma[k]), i == k ? 1 : 0, 0.04);
}

TEST(PotentialRun, ShowsWhatLateAndNoisyAnglesDo) {
  const DistributedArm arm = three_section_arm();
  const PotentialLaw law(arm, evenly_bent(arm, 1.2, -0.6), {});
  const AngleMeasurement noisy{.step = 0.02, .delay = 0.06, .noise = {0.01, 0.01}, .seed = 7};
  PotentialRun run(arm, law, evenly_bent(arm, 0, 0), noisy), again(arm, law, evenly_bent(arm, 0, 0), noisy);
  const LyapunovVerdict verdict = watched(run, 4);
  EXPECT_FALSE(verdict.is_monotone);
  EXPECT_FALSE(verdict.is_balanced);
  EXPECT_GT(verdict.largest_rise, 1e-5);
  EXPECT_LT((run.motion().x() - law.target()).cwiseAbs().maxCoeff(), 0.05);  // It still gets there.
  ASSERT_TRUE(again.advance(4));                                             // Reproducibly.
  EXPECT_EQ(again.motion().x(), run.motion().x());
  // If the delay is large against the damping's time, it swings up instead.
  PotentialRun late(arm, PotentialLaw(arm, evenly_bent(arm, 1.2, -0.6), {.stiffness = {100, 100}}),
                    evenly_bent(arm, 0, 0), {{.delay = 0.2}});
  const LyapunovVerdict swung = watched(late, 2);
  EXPECT_FALSE(swung.is_settled);
  EXPECT_GT(swung.largest_rise, 1);
}

TEST(PotentialRun, EndsWhereTheAnglesDo) {
  const DistributedArm arm = three_section_arm();
  // The damping has the wrong sign: the arm swings up until an angle is singular.
  const PotentialLaw wild(arm, evenly_bent(arm, 0.3, 1.2), {.damping = -2 * Eigen::Matrix2d::Identity()});
  PotentialRun run(arm, wild, evenly_bent(arm, 0, 0.3));
  const LyapunovVerdict verdict = watched(run, 5);
  EXPECT_THAT(run.stopped(), HasSubstr("|q| reached 90 deg at "));
  EXPECT_LT(run.motion().arm().q().cwiseAbs().maxCoeff(), 1.5707963268);
  EXPECT_GT(run.motion().arm().q().cwiseAbs().maxCoeff(), 1.56);
  EXPECT_THAT(verdict.reasons, Contains(HasSubstr("the damping K is not positive")));
  const double ended = run.motion().time();
  EXPECT_FALSE(run.advance(6));
  EXPECT_EQ(run.motion().time(), ended);
}

// In its own plane the angles have no limit: it turns faster and faster.
TEST(PotentialRun, EndsWhereTheArmRunsAway) {
  const DistributedArm arm = three_section_arm();
  const PotentialLaw wild(arm, evenly_bent(arm, 0.3, 0), {.damping = -2 * Eigen::Matrix2d::Identity()});
  PotentialRun run(arm, wild, evenly_bent(arm, 0.6, 0));
  (void)watched(run, 60);
  EXPECT_THAT(run.stopped(), HasSubstr("the motion diverges: at "));
  EXPECT_GT(run.motion().arm().theta().cwiseAbs().maxCoeff(), 99);
}

TEST(PotentialRun, EndsWithinAnAdvanceWhereItIsTold) {
  const DistributedArm arm = three_section_arm();
  const PotentialLaw law(arm, evenly_bent(arm, 1.2, -0.6), {});
  for (const auto& measurement : {std::optional<AngleMeasurement>(), std::optional(AngleMeasurement{})}) {
    PotentialRun run(arm, law, evenly_bent(arm, 0, 0), measurement), whole(arm, law, evenly_bent(arm, 0, 0));
    int asked = 0;
    EXPECT_FALSE(run.advance(5, [&] { return ++asked <= 20; }));
    EXPECT_EQ(asked, 21);
    EXPECT_EQ(run.stopped(), "cancelled");
    EXPECT_GT(run.motion().time(), 0);
    EXPECT_LT(run.motion().time(), 1);
    EXPECT_EQ(run.sample().time, run.motion().time());
    EXPECT_FALSE(run.advance(5));
    EXPECT_TRUE(whole.advance(0.1, [] { return true; }));
  }
}

TEST(PotentialRun, EndsAtOnceWhereItCannotStart) {
  const DistributedArm arm = three_section_arm();
  const PotentialLaw law(arm, evenly_bent(arm, 0, 0), {});
  PotentialRun run(arm, law, evenly_bent(arm, 0, 1.8));
  EXPECT_THAT(run.stopped(), HasSubstr("|q| reached 90 deg at 0.000 s"));
  EXPECT_FALSE(run.advance(1));
}

TEST(PotentialRun, EndsWhereItCannotBeFollowed) {
  const DistributedArm arm({.bending_stiffness = 1e6, .nodes = 4, .points = 8});
  const PotentialLaw law(arm, evenly_bent(arm, 1, 0), {.elasticity = ElasticityRule::ignored});
  PotentialRun run(arm, law, evenly_bent(arm, 0, 0), {}, {.most_steps = 500});
  EXPECT_FALSE(run.advance(1));
  EXPECT_THAT(run.stopped(), HasSubstr("too fast for the integration"));
}

TEST(PotentialRun, RefusesNumbersThatAreNone) {
  const DistributedArm arm = three_section_arm();
  const PotentialLaw law(arm, evenly_bent(arm, 1, 0), {});
  const Eigen::VectorXd start = evenly_bent(arm, 0, 0);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PotentialRun(arm, law, Eigen::VectorXd::Zero(2)), std::invalid_argument);
  EXPECT_THROW(PotentialRun(arm, law, nan * start), std::invalid_argument);
  for (const AngleMeasurement& bad : {AngleMeasurement{.step = 0}, AngleMeasurement{.step = nan},
                                      AngleMeasurement{.delay = -1}, AngleMeasurement{.noise = {nan, 0}}})
    EXPECT_THROW(PotentialRun(arm, law, start, bad), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
