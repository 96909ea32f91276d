#include "flexura/model/arm_difference.h"

#include <gtest/gtest.h>

namespace flexura {
namespace {

const ArmState here{{{0.5, -0.25}, {1, 2}}, {1, 0.75}}, there{{{1.5, 0.25}, {-1, 2}}, {1.25, 0.5}};

TEST(ArmDifference, LeadsFromOneStateToTheOther) {
  EXPECT_EQ(plus(here, minus(there, here)), there);
  EXPECT_EQ(plus(there, minus(there, here), -1), here);
  EXPECT_EQ(plus(here, minus(there, here), 0.5), (ArmState{{{1, 0}, {0, 2}}, {1.125, 0.625}}));
}

// Numbers whose difference is rounded.
TEST(ArmDifference, InterpolationEndsExactlyWhereItShall) {
  const ArmState tenth{{{0.1, 0}}, {1.1}}, huge{{{1e17, 0.3}}, {0.7}};
  EXPECT_NE(plus(huge, minus(tenth, huge)), tenth);
  EXPECT_EQ(interpolate(huge, tenth, 1), tenth);
  EXPECT_EQ(interpolate(huge, tenth, 0), huge);
  EXPECT_EQ(interpolate(here, there, 0.5), (ArmState{{{1, 0}, {0, 2}}, {1.125, 0.625}}));
}

}  // namespace
}  // namespace flexura
