#include <gtest/gtest.h>

#include "tests/support/sampled_check.h"

namespace flexura {
namespace {

TEST(MotionCheckFull, MissesNothingThatDenseSamplingFinds) {
  SampledComparison result;
  for_random_cases(10, [&](TestRandom& random) {
    compare_with_samples(random, 50'000, result);
    EXPECT_EQ(result.missed, 0U);
    EXPECT_EQ(result.contacts_missed, 0U);
    EXPECT_EQ(result.refuted, 0U);
    EXPECT_EQ(result.understated, 0U);
    EXPECT_EQ(result.overstated, 0U);
  });
  EXPECT_GE(result.motions, 60U);  // Planar arms have some more.
}

}  // namespace
}  // namespace flexura
