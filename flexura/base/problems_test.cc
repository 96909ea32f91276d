#include "flexura/base/problems.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flexura {
namespace {

TEST(Joined, HasTheColumnsOfOneLineButNotTheLineItself) {
  EXPECT_EQ(joined({{{{}, 1, 3}, "bends: 1 given"}, {{{}, 1, 1}, "at: expected numbers"}}),
            "column 3: bends: 1 given; at: expected numbers");
  EXPECT_EQ(joined({}), "");
}

// A line of a million unknown keys gets a short answer.
TEST(Joined, TellsTheFirstAndHowManyMoreThereAre) {
  const std::string text = joined(std::vector<Problem>(1000, {{}, "unknown key"}));
  EXPECT_THAT(text, ::testing::EndsWith("unknown key; and 980 more"));
  EXPECT_LT(text.size(), 300U);
}

}  // namespace
}  // namespace flexura
