#include <gtest/gtest.h>

#include "tests/support/sampled_check.h"

namespace flexura {
namespace {

TEST(MotionCheckFull, MissesNothingThatDenseSamplingFinds) {
  SampledComparison result;
  for_random_cases(3, [&](TestRandom& random) {
    compare_with_samples(random, 5000, result);
    EXPECT_EQ(result.missed, 0U);
    EXPECT_EQ(result.contacts_missed, 0U);
    EXPECT_EQ(result.refuted, 0U);
    EXPECT_EQ(result.understated, 0U);
    EXPECT_EQ(result.overstated, 0U);
  });
  EXPECT_GE(result.motions, 18U);  // Planar arms have some more.
}

// Coils that each touch many others all the time: contact is checked often, depth rarely. A regression takes
// minutes, longer than a test may run.
TEST(MotionCheckFull, OfALongArmThatIsCoiledUpTakesNoMinutes) {
  Arm arm;
  arm.sections.assign(8, {.length = 0.1, .radius = {0.01, 0.01}});
  const ArmState straight = ArmState::straight(8);
  ArmState coiled = straight;
  for (std::size_t i = 0; i < coiled.bends.size(); ++i) coiled.bends[i] = {10, 0.3 * static_cast<double>(i)};
  const MotionPtr motion = keyframe_motion({0, 10}, {straight, coiled}, Interpolation::linear);
  const SafetyReport report = check_motions(arm, {}, straight, {{motion, 0, "coil"}}, 0.02);
  EXPECT_FALSE(report.is_safe());
}

}  // namespace
}  // namespace flexura
