#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>

#include "flexura/control/distributed_arm.h"
#include "flexura/control/feature_images.h"
#include "flexura/control/image_law.h"
#include "flexura/control/potential_law.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_views.h"

// Sanitizers have their own allocator.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include "tests/support/malloc_count.h"

namespace flexura {
namespace {

TEST(Allocation, HappensInNoStepOfTheArmOrItsLaw) {
  DistributedArm arm({.lengths = {0.5, 0.5},
                      .has_variable_lengths = true,
                      .bending_stiffness = 0.3,
                      .axial_stiffness = 50,
                      .damping = 0.1});
  const PotentialLaw law(arm, arm.coordinates([](double s) { return Eigen::Vector2d(s, 0.5 * s); }), {});
  Eigen::VectorXd x = Eigen::VectorXd::Constant(arm.size(), 0.01), v = x, Q = x, a = x;
  const auto step = [&] {
    arm.set(x, v);
    law.force(arm, x, v, Q);
    return arm.accelerate(Q, a);
  };
  ASSERT_TRUE(step());
  const long before = mallocs;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(step());
  EXPECT_EQ(mallocs - before, 0);
  // Checks that allocations are counted.
  const Eigen::VectorXd other = 2 * x;
  EXPECT_GT(mallocs - before, 0);
  EXPECT_EQ(other[0], 0.02);
}

TEST(Allocation, HappensInNoStepOfALawOnImages) {
  const Arm arm = servo_arm();
  const std::array<View, 2> views = servo_views();
  FeatureSet both = FeatureSet::of_points(25);
  both.chords = FeatureSet::of_chords(9).chords;
  for (const FeatureSet& set : {both, FeatureSet::of_moments()}) {
    FeatureImages images(arm, set);
    const ImageLaw law(arm, {});
    ImageLaw::Work work;
    ImageStep step;
    Eigen::VectorXd seen, desired, error;
    Eigen::MatrixXd by_state, J;
    ArmState state = {{{0.4, 0.1}, {-0.2, 0.5}, {0.1, 0.3}}, {1, 1, 1}};
    const ArmState target = {{{0.5, 0.1}, {-0.2, 0.1}, {0.3, 0.3}}, {1, 1, 1}};
    const auto control = [&] {
      const bool is_seen =
          images.derive(state, views, seen, by_state) && images.values(target, views, desired);
      law.by_variables(by_state, J);
      feature_error(set, seen, desired, error);
      law.step(state, error, J, 1.0 / 30, work, step);
      state = step.asked;
      return is_seen && !step.is_singular;
    };
    ASSERT_TRUE(control());
    const long before = mallocs;
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(control());
    EXPECT_EQ(mallocs - before, 0);
  }
}

}  // namespace
}  // namespace flexura

#endif
