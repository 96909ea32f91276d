#include "flexura/control/section_drives.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>

#include "flexura/control/potential_law.h"
#include "tests/support/distributed_arms.h"

namespace flexura {
namespace {

TEST(SectionDrives, GiveTheWholeForceWhereTheyMoveAllThatMoves) {
  for_random_cases(6, [](TestRandom& random) {
    const DistributedArm arm({.lengths = {0.3, 0.4, 0.3},
                              .has_variable_lengths = true,
                              .bending_stiffness = 0.3,
                              .axial_stiffness = 40,
                              .basis = AngleBasis::sections,
                              .nodes = 1,
                              .points = 5});
    for (const DriveKind kind : {DriveKind::moments, DriveKind::torques}) {
      const Eigen::MatrixXd G = drives_of(arm, kind);
      ASSERT_EQ(G.rows(), 9);
      ASSERT_EQ(G.cols(), 9);
      const PotentialLaw law(arm, random_coordinates(random, arm, 0.8), {});
      PotentialRun run(arm, law, random_coordinates(random, arm, 0.8), {}, {}, G);
      EXPECT_THAT(watched(run, 3, 0.03).reasons, testing::IsEmpty());
      EXPECT_LE(run.left_over(), 1e-10);
    }
  });
}

TEST(SectionDrives, MoveTheNumbersThatTheySayTheyDo) {
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

// Two drives per angle, four numbers: with the law's force projected onto the drives, W does not decrease.
TEST(SectionDrives, LeaveForcesOverOfAnArmThatHasMoreThanTheyMove) {
  const DistributedArm arm(
      {.lengths = {0.5, 0.5}, .bending_stiffness = 2, .damping = 0.5, .nodes = 4, .points = 8});
  const auto bent = [&](double theta, double q) {
    return arm.coordinates([&](double s) { return Eigen::Vector2d(theta * s, q * s); });
  };
  const PotentialLaw law(arm, bent(0.6, -0.1), {});
  PotentialRun run(arm, law, bent(-0.3, 0.2), {}, {}, section_moments(arm));
  const LyapunovVerdict cut = watched(run, 3, 0.03);
  EXPECT_FALSE(cut.is_balanced);
  EXPECT_THAT(cut.reasons, testing::Contains(testing::HasSubstr("not the forces of the law")));
  EXPECT_GT(run.left_over(), 0.01);
}

}  // namespace
}  // namespace flexura
