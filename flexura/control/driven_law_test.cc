#include "flexura/control/driven_law.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "flexura/control/lyapunov_monitor.h"
#include "flexura/control/potential_law.h"
#include "tests/support/distributed_arms.h"
#include "tests/support/watched_runs.h"

namespace flexura {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

Eigen::VectorXd line_of_angles(const DistributedArm& arm, double theta, double q) {
  return arm.coordinates([&](double s) { return Eigen::Vector2d(theta * s, q * s); });
}

TEST(DrivenLaw, ProjectsExactlyWhereTheDrivesMoveAllThatMoves) {
  for_random_cases(6, [](TestRandom& random) {
    const DistributedArm arm({.lengths = {0.3, 0.4, 0.3},
                              .has_variable_lengths = true,
                              .bending_stiffness = 0.3,
                              .axial_stiffness = 40,
                              .basis = AngleBasis::sections,
                              .nodes = 1,
                              .points = 5});
    for (const Eigen::MatrixXd& G : {section_moments(arm), section_torques(arm)}) {
      ASSERT_EQ(G.rows(), 9);
      ASSERT_EQ(G.cols(), 9);
      const PotentialLaw law(arm, random_coordinates(random, arm, 0.8), {});
      double left_over = 0;
      const auto driven = [&](double, const DistributedArm& now, const Eigen::VectorXd& x,
                              const Eigen::VectorXd& v, Eigen::VectorXd& Q) {
        law.force(now, x, v, Q);
        const ProjectedForce projected = project_on_drives(G, Q);
        left_over = std::max(left_over, projected.left_over);
        Q = projected.force;
        return law.dissipation(v);
      };
      const LyapunovVerdict verdict = watched_run(arm, law, driven, random_coordinates(random, arm, 0.8), 3);
      EXPECT_THAT(verdict.reasons, IsEmpty());
      EXPECT_LE(left_over, 1e-10);
    }
  });
}

TEST(DrivenLaw, HasNumbersThatAreWhatItsDrivesMove) {
  for_random_cases(20, [](TestRandom& random) {
    DistributedArmModel model = random_distributed_arm(random);
    model.clamp = {0.2, -0.1};
    DistributedArm arm(model);
    const Eigen::VectorXd x = random_coordinates(random, arm);
    arm.set(x, Eigen::VectorXd::Zero(arm.size()));
    const AngleShapes& shapes = arm.shapes();
    const Eigen::VectorXd sums = section_torques(arm).transpose() * x,
                          turns = section_moments(arm).transpose() * x;
    const Eigen::VectorXd base_part = 0.2 * shapes.base;
    double start = 0;
    for (std::size_t k = 0; k < model.lengths.size(); ++k) {
      double integral = 0;
      for (Eigen::Index j = 0; j < shapes.s.size(); ++j)
        if (shapes.section[static_cast<std::size_t>(j)] == k)
          integral += shapes.weights[j] * (arm.theta()[j] - base_part[j]);
      const auto column = static_cast<Eigen::Index>(2 * k);
      EXPECT_NEAR(sums[column], integral, 1e-12);
      const double end = start + model.lengths[k];
      EXPECT_NEAR(
          turns[column + 1],
          (shapes.at(end) - shapes.at(start)).head(arm.nodes()).dot(x.segment(arm.nodes(), arm.nodes())),
          1e-12);
      start = end;
    }
  });
}

TEST(DrivenLaw, FallsOnAnArmThatHasMoreThanItsDrivesMove) {
  // Two drives an angle, six numbers: the law's force cut down to the drives does not let W fall; the
  // potential on the drives' own numbers does.
  DistributedArm arm(
      {.lengths = {0.5, 0.5}, .bending_stiffness = 2, .damping = 0.5, .nodes = 4, .points = 8});
  const Eigen::MatrixXd G = section_moments(arm);
  Eigen::VectorXd hold(4);
  hold << 1.2, 0.5, -0.6, 0.4;
  const auto target = equilibrium(arm, Eigen::VectorXd::Zero(arm.size()), G * hold);
  ASSERT_TRUE(target.has_value());
  const Eigen::VectorXd start = line_of_angles(arm, -0.3, 0.2);

  const PotentialLaw full(arm, *target, {});
  const LyapunovVerdict cut = watched_run(
      arm, full,
      [&](double, const DistributedArm& now, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
          Eigen::VectorXd& Q) {
        full.force(now, x, v, Q);
        Q = project_on_drives(G, Q).force;
        return full.dissipation(v);
      },
      start, 3);
  EXPECT_FALSE(cut.is_balanced);
  EXPECT_THAT(cut.reasons, Contains(HasSubstr("not those of the law")));

  const DrivenLaw law(arm, G, *target, 4, 1);
  EXPECT_THAT(law.violations(), IsEmpty());
  EXPECT_LE((law.holding() - hold).cwiseAbs().maxCoeff(), 1e-9);
  DistributedMotion motion(
      arm,
      [&](double, const DistributedArm&, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
          Eigen::VectorXd& Q) {
        law.force(x, v, Q);
        return law.dissipation(v);
      },
      fine);
  motion.start(start);
  LyapunovMonitor monitor;
  for (int i = 1; i <= 100; ++i) {
    monitor.add({motion.time(), motion.arm().kinetic_energy(), law.potential(motion.arm(), motion.x()), 0, 0,
                 motion.summed(), motion.damped()});
    ASSERT_TRUE(motion.advance(0.05 * i));
  }
  EXPECT_THAT(monitor.verdict().reasons, IsEmpty());
  EXPECT_LE((motion.x() - *target).cwiseAbs().maxCoeff(), 2e-2);

  EXPECT_THAT(DrivenLaw(arm, G, line_of_angles(arm, 1, 1), 4, 1).violations(),
              Contains(HasSubstr("cannot hold")));
  EXPECT_THAT(DrivenLaw(arm, G, *target, 4, -1).violations(), Contains(HasSubstr("not positive")));
  EXPECT_THAT(DrivenLaw(arm, G, *target, -40, 1).violations(), Contains(HasSubstr("no minimum")));
}

}  // namespace
}  // namespace flexura
