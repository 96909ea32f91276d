#include "flexura/control/potential_law.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/control/lyapunov_monitor.h"
#include "flexura/math/derivative_check.h"
#include "tests/support/distributed_arms.h"

namespace flexura {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

// A run from rest, until the coordinates become singular at most.
LyapunovVerdict watched_run(const DistributedArm& arm, const PotentialLaw& law, const Eigen::VectorXd& start,
                            double until, Eigen::VectorXd& end) {
  PotentialRun run(arm, law, start, {}, {.relative = 1e-9, .absolute = 1e-11});
  const LyapunovVerdict verdict = watched(run, until, until / 100);
  end = run.motion().x();
  return verdict;
}

DistributedArm small_arm(std::optional<double> bending = {}) {
  return DistributedArm({.bending_stiffness = bending.value_or(0.5), .nodes = 3, .points = 8});
}

Eigen::VectorXd bent(const DistributedArm& arm, double theta, double q) {
  return arm.coordinates([&](double s) { return Eigen::Vector2d(theta * s, q * s); });
}

TEST(PotentialLaw, IsThePapersAtEveryPoint) {
  // F_theta = -k e_theta - rho g (L - s) sin theta cos q - K theta_t, and F_q correspondingly, Y up, e
  // measured minus desired. At nodes that are also the points, a force per length is multiplied by the
  // point's weight.
  for_random_cases(20, [](TestRandom& random) {
    DistributedArmModel model{
        .density = random.uniform(0.5, 2), .clamp = std::nullopt, .nodes = 6, .points = 6};
    DistributedArm arm(model);
    const Eigen::VectorXd x = random_coordinates(random, arm), v = random_rates(random, arm),
                          target = random_coordinates(random, arm);
    const PotentialLaw law(arm, target, {});
    arm.set(x, v);
    Eigen::VectorXd Q;
    law.force(arm, x, v, Q);
    const Eigen::Index n = arm.nodes();
    for (Eigen::Index i = 0; i < n; ++i) {
      const double theta = x[i], q = x[n + i], weight = arm.shapes().weights[i];
      const double load = model.density * 9.81 * (1 - arm.shapes().s[i]);
      EXPECT_NEAR(Q[i] / weight, -20 * (theta - target[i]) - load * std::sin(theta) * std::cos(q) - 4 * v[i],
                  1e-10);
      EXPECT_NEAR(Q[n + i] / weight,
                  -20 * (q - target[n + i]) - load * std::cos(theta) * std::sin(q) - 4 * v[n + i], 1e-10);
    }
  });
}

TEST(PotentialLaw, PushesDownTheSlopeOfItsPotential) {
  for_random_cases(40, [](TestRandom& random) {
    DistributedArm arm(random_distributed_arm(random));
    const Eigen::VectorXd x = random_coordinates(random, arm), target = random_coordinates(random, arm),
                          still = Eigen::VectorXd::Zero(arm.size());
    for (const ElasticityRule rule : {ElasticityRule::cancelled, ElasticityRule::shaped}) {
      const PotentialLaw law(arm, target, {.stiffness = {20, 13}, .elasticity = rule});
      const auto slope = numerical_jacobian(
          [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
            arm.set(at, still);
            return Eigen::VectorXd::Constant(1, law.potential(arm, at));
          },
          x, 0.02);
      arm.set(x, still);
      Eigen::VectorXd Q;
      law.force(arm, x, still, Q);
      const Eigen::VectorXd net = Q - arm.gravity_gradient() - arm.elastic_gradient();
      EXPECT_LE((net + slope.value.transpose()).cwiseAbs().maxCoeff(),
                1e-8 * (1 + net.cwiseAbs().maxCoeff()));
      arm.set(target, still);
      EXPECT_NEAR(law.potential(arm, target), 0, 1e-12);
      EXPECT_GT((arm.set(x, still), law.potential(arm, x)), 0);
    }
  });
}

TEST(PotentialLaw, LetsLyapunovsFunctionFallOnEveryRun) {
  double rise = 0, imbalance = 0;
  for_random_cases(8, [&](TestRandom& random) {
    DistributedArmModel model = random_distributed_arm(random);
    model.nodes = random.integer(2, 4);
    if (random.integer(0, 1) == 1) model.damping = 0.3, model.length_damping = 2;
    const DistributedArm arm(model);
    PotentialGains gains;
    gains.stiffness = random.vector<2>(10, 30);
    gains.damping << random.uniform(2, 5), 0.5, 0.5, random.uniform(2, 5);
    if (random.integer(0, 1) == 1) gains.elasticity = ElasticityRule::shaped;
    const Eigen::VectorXd target = random_coordinates(random, arm, 0.8);
    const PotentialLaw law(arm, target, gains);
    EXPECT_THAT(law.violations(), IsEmpty());
    Eigen::VectorXd end;
    const LyapunovVerdict verdict = watched_run(arm, law, random_coordinates(random, arm, 0.8), 4, end);
    EXPECT_TRUE(verdict.is_monotone) << verdict.largest_rise;
    EXPECT_TRUE(verdict.is_balanced) << verdict.imbalance;
    EXPECT_TRUE(verdict.is_settled);
    EXPECT_THAT(verdict.reasons, IsEmpty());
    EXPECT_LE((end - target).cwiseAbs().maxCoeff(), 2e-2);
    rise = std::max(rise, verdict.largest_rise), imbalance = std::max(imbalance, verdict.imbalance);
  });
  std::printf("largest rise of W %.1e J, largest imbalance %.1e J\n", rise, imbalance);
}

TEST(PotentialLaw, BringsLengthsToTheirTargetsToo) {
  DistributedArmModel model{.lengths = {0.5, 0.4},
                            .has_variable_lengths = true,
                            .bending_stiffness = 0.1,
                            .axial_stiffness = 50,
                            .nodes = 3,
                            .points = 6};
  const DistributedArm arm(model);
  Eigen::VectorXd target = bent(arm, 1, -0.6);
  target.tail(2) << 0.12, -0.08;
  const PotentialLaw law(arm, target, {});
  Eigen::VectorXd end;
  const LyapunovVerdict verdict = watched_run(arm, law, bent(arm, -0.4, 0.3), 4, end);
  EXPECT_THAT(verdict.reasons, IsEmpty());
  EXPECT_LE((end - target).cwiseAbs().maxCoeff(), 1e-3);
}

// A run of a law that violates a condition: violations that it reports, and result of the run.
struct Violated {
  std::vector<std::string> reported;
  LyapunovVerdict shown;
  double off = 0;  // In rad, at the end.
};
Violated violated(const DistributedArm& arm, const PotentialGains& gains) {
  const Eigen::VectorXd target = bent(arm, 1, 0.5);
  const PotentialLaw law(arm, target, gains);
  Eigen::VectorXd end;
  Violated result;
  result.reported = law.violations();
  result.shown = watched_run(arm, law, bent(arm, 0.3, -0.2), 3, end);
  result.off = (end - target).cwiseAbs().maxCoeff();
  return result;
}

TEST(PotentialLaw, FailsWithItsReasonWhereAConditionIsViolated) {
  const DistributedArm arm = small_arm();
  const Violated good = violated(arm, {});
  EXPECT_THAT(good.reported, IsEmpty());
  EXPECT_THAT(good.shown.reasons, IsEmpty());
  EXPECT_LE(good.off, 1e-2);

  const Violated excited = violated(arm, {.damping = -0.3 * Eigen::Matrix2d::Identity()});
  EXPECT_THAT(excited.reported, Contains(HasSubstr("K is not positive")));
  EXPECT_THAT(excited.shown.reasons, Contains(HasSubstr("K is not positive")));
  EXPECT_FALSE(excited.shown.is_monotone);
  EXPECT_FALSE(excited.shown.is_settled);

  const Violated undamped = violated(arm, {.damping = Eigen::Matrix2d::Zero()});
  EXPECT_THAT(undamped.reported, Contains(HasSubstr("K is not positive")));
  EXPECT_THAT(undamped.shown.reasons, Contains(HasSubstr("damping removed no energy")));
  EXPECT_FALSE(undamped.shown.is_settled);

  const Violated heavy = violated(arm, {.gravity_share = 0});
  EXPECT_THAT(heavy.reported, Contains(HasSubstr("0 % of gravity is compensated")));
  EXPECT_THAT(heavy.shown.reasons, Contains(HasSubstr("gravity is not fully compensated: 100 %")));
  EXPECT_GT(heavy.off, 0.05);

  const Violated lifted = violated(arm, {.gravity_share = -1});
  EXPECT_THAT(lifted.shown.reasons, Contains(HasSubstr("gravity is not fully compensated: 200 %")));
  EXPECT_GT(lifted.off, 0.1);

  const Violated stiff = violated(small_arm(4), {.elasticity = ElasticityRule::ignored});
  EXPECT_THAT(stiff.reported, Contains(HasSubstr("elasticity")));
  EXPECT_THAT(stiff.shown.reasons, Contains(HasSubstr("elasticity is not fully compensated: 100 %")));
  EXPECT_GT(stiff.off, 0.05);

  const Violated wrong = violated(arm, {.sign = -1});
  EXPECT_THAT(wrong.reported, Contains(HasSubstr("sign")));
  EXPECT_THAT(wrong.shown.reasons, Contains(HasSubstr("drives the arm away")));
  EXPECT_GT(wrong.off, 0.5);

  for (const Violated& one : {excited, undamped, heavy, lifted, stiff, wrong}) {
    EXPECT_FALSE(one.shown.is_good());
    EXPECT_FALSE(one.reported.empty());
    EXPECT_FALSE(one.shown.is_settled && one.shown.is_monotone && one.shown.is_balanced);
  }
}

// Elasticity pulls towards the straight arm at its own length anyway.
TEST(PotentialLaw, MayIgnoreElasticityThatIsAtRestAtTheTarget) {
  DistributedArmModel model{.lengths = {0.5, 0.4},
                            .has_variable_lengths = true,
                            .bending_stiffness = 2,
                            .axial_stiffness = 50,
                            .clamp = {{0.7, -0.3}},
                            .nodes = 3,
                            .points = 6};
  for (const AngleBasis basis : {AngleBasis::polynomial, AngleBasis::sections}) {
    model.basis = basis;
    const DistributedArm arm(model);
    const Eigen::VectorXd straight = arm.coordinates([](double) { return Eigen::Vector2d(0.7, -0.3); });
    const PotentialGains ignoring{.elasticity = ElasticityRule::ignored};
    const PotentialLaw law(arm, straight, ignoring);
    EXPECT_THAT(law.violations(), IsEmpty());
    Eigen::VectorXd start = bent(arm, 1, -0.6), end;
    start.tail(2) << 0.05, -0.05;
    const LyapunovVerdict verdict = watched_run(arm, law, start, 4, end);
    EXPECT_THAT(verdict.reasons, IsEmpty());
    EXPECT_TRUE(verdict.is_monotone);
    EXPECT_LE((end - straight).cwiseAbs().maxCoeff(), 1e-2);
    // From slightly stretched or bent targets, elasticity pulls it away.
    Eigen::VectorXd stretched = straight, tilted = straight;
    stretched[arm.size() - 1] += 1e-4, tilted[arm.nodes() - 1] += 1e-4;
    for (const Eigen::VectorXd& target : {stretched, tilted})
      EXPECT_THAT(PotentialLaw(arm, target, ignoring).violations(),
                  testing::ElementsAre(HasSubstr("elasticity is neither cancelled nor part")));
  }
}

TEST(PotentialLaw, NeedsAMinimumOfPotentialAndElasticityTogether) {
  // An arc of 2.6 rad in one plane, which nothing holds in that plane: elasticity turns it out.
  const DistributedArm arm({.bending_stiffness = 4, .nodes = 4, .points = 10});
  const Eigen::VectorXd target = bent(arm, 2.6, 0);
  PotentialGains gains{.stiffness = {0.2, 0.2}, .elasticity = ElasticityRule::shaped};
  const PotentialLaw law(arm, target, gains);
  EXPECT_THAT(law.violations(), Contains(HasSubstr("no minimum")));
  Eigen::VectorXd start = target, end;
  start.tail(arm.nodes()).array() += 0.01;
  const LyapunovVerdict verdict = watched_run(arm, law, start, 4, end);
  EXPECT_FALSE(verdict.is_settled);
  EXPECT_THAT(verdict.reasons, Contains(HasSubstr("no minimum at the target")));
  EXPECT_GT(end.tail(arm.nodes()).cwiseAbs().maxCoeff(), 0.2);
  gains.stiffness = {60, 60};
  EXPECT_THAT(PotentialLaw(arm, target, gains).violations(), IsEmpty());
}

TEST(PotentialLaw, RefusesNumbersThatAreNone) {
  const DistributedArm arm = small_arm();
  const Eigen::VectorXd target = bent(arm, 1, 0);
  EXPECT_THROW(PotentialLaw(arm, target.head(2), {}), std::invalid_argument);
  EXPECT_THROW(PotentialLaw(arm, target * std::numeric_limits<double>::infinity(), {}),
               std::invalid_argument);
  EXPECT_THROW(PotentialLaw(arm, target, {.gravity_share = std::nan("")}), std::invalid_argument);
  EXPECT_THAT(PotentialLaw(arm, target, {.stiffness = {1, 0}}).violations(),
              Contains(HasSubstr("no minimum")));
}

TEST(LyapunovMonitor, RefusesSamplesThatAreNone) {
  LyapunovMonitor monitor;
  EXPECT_THROW((void)monitor.verdict(), std::logic_error);
  monitor.add({.time = 0, .potential = 1});
  EXPECT_THROW(monitor.add({.time = 0}), std::invalid_argument);
  EXPECT_THROW(monitor.add({.time = 1, .kinetic = std::nan("")}), std::invalid_argument);
  monitor.add({.time = 1, .potential = 0.9, .taken = 0.1});
  EXPECT_TRUE(monitor.verdict().is_balanced);
  EXPECT_THAT(monitor.verdict().reasons, Contains(HasSubstr("not settled")));
  monitor.add({.time = 2, .potential = 1.2, .taken = 0.1});
  EXPECT_NEAR(monitor.verdict().largest_rise, 0.3, 1e-12);
  EXPECT_FALSE(monitor.verdict().is_good());
}

}  // namespace
}  // namespace flexura
