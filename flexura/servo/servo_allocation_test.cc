#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>

#include "flexura/servo/servo_law.h"
#include "tests/support/servo_views.h"

// Sanitizers have their own allocator.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include "tests/support/malloc_count.h"

namespace flexura {
namespace {

// The law keeps its matrices: a step with the law `shape` allocates only the returned state.
TEST(ServoLaw, AllocatesNothingButItsAnswer) {
  for (const ServoJacobian jacobian : {ServoJacobian::model, ServoJacobian::recursive}) {
    const Arm arm = servo_arm();
    ServoConfig config;
    config.jacobian = jacobian;
    const auto features = servo_features(config.law, arm, config.points);
    ServoLaw law(ArmModel(arm), config, *features);
    ServoObservation observed;
    observed.seen[0].view = servo_views()[0], observed.seen[1].view = servo_views()[1];
    observed.estimate.shape.state = {{{0.4, 0.1}, {-0.2, 0.5}, {0.1, 0.3}}, {1, 1, 1}};
    const ArmState& state = observed.estimate.shape.state;
    observed.rest = state;
    const TargetShape desired{{{{0.5, 0.1}, {-0.2, 0.1}, {0.3, 0.3}}, {1, 1, 1}}, {}};
    const ServoLaw::Input input{.observed = observed,
                                .is_fresh = false,
                                .measured = state,
                                .sent = state,
                                .then = desired,
                                .desired = desired,
                                .next = desired.state};
    for (int i = 0; i < 2; ++i) EXPECT_FALSE(law.step(input).is_singular);
    const long before = mallocs;
    for (int i = 0; i < 10; ++i) (void)law.step(input);
    constexpr long of_a_state = 2;  // Allocations of a state: bends and stretches.
    EXPECT_LE(mallocs - before, 10 * of_a_state);
  }
}

// Target features of both images, and their derivatives.
TEST(ServoFeatures, AllocateNothingOnceTheyHaveServed) {
  const Arm arm = servo_arm();
  const std::array<View, 2> views = servo_views();
  const ArmState state = {{{0.4, 0.1}, {-0.2, 0.5}, {0.1, 0.3}}, {1, 1, 1}};
  for (const ServoLawKind law : {ServoLawKind::shape, ServoLawKind::points, ServoLawKind::chords,
                                 ServoLawKind::moments, ServoLawKind::silhouettes}) {
    const auto features = servo_features(law, arm, 12);
    Eigen::VectorXd values;
    FeatureError error;
    const ArmState desired = {{{0.5, 0.1}, {-0.2, 0.1}, {0.3, 0.3}}, {1, 1, 1}},
                   halfway = {{{0.45, 0.1}, {-0.2, 0.3}, {0.2, 0.3}}, {1, 1, 1}};
    const auto look = [&] {
      return features->predict(state, views, values) &&
             features->error(values, values, state, views, error) &&
             features->secant(values, values, {state, desired, halfway}, views, error);
    };
    ASSERT_TRUE(look());
    const long before = mallocs;
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(look());
    EXPECT_EQ(mallocs - before, 0);
  }
}

}  // namespace
}  // namespace flexura

#endif
