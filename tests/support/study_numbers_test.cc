#include "tests/support/study_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(StudyNumbers, AQuantileIsTheNearestRank) {
  EXPECT_EQ(quantile({3, 1, 2, 4}, 0.5), 2);
  EXPECT_EQ(quantile({3, 1, 2, 4}, 0.51), 3);
  // Only half of the two values lie below the larger one.
  EXPECT_EQ(quantile({1, 2}, 0.999), 2);
  EXPECT_EQ(quantile({1, 2}, 0), 1);
  EXPECT_EQ(quantile({1, 2}, 1), 2);
  EXPECT_EQ(quantile({none, 1}, 1), 1);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(StudyNumbers, AnAimIsMetUpToItselfAndOfNothingThereIsNoVerdict) {
  EXPECT_EQ(verdict(0.02, 0.02), "met");
  EXPECT_EQ(verdict(0.0201, 0.02), "missed");
  EXPECT_EQ(verdict(quantile({}, 0.999), 0.05), "not tested");
  EXPECT_EQ(verdict(root_mean_square({}), 0.02), "not tested");
}

TEST(StudyNumbers, EvenSharesAreToldFromUnevenOnes) {
  TestRandom random(1);
  std::vector<double> even(2000), uneven(2000);
  for (double& share : even) share = random.uniform(0, 1);
  for (double& share : uneven) share = std::pow(random.uniform(0, 1), 1.2);
  constexpr double rare = 27.88;  // Exceeded once in a thousand, with nine degrees of freedom.
  EXPECT_LT(unevenness(even), rare);
  EXPECT_GT(unevenness(uneven), rare);
}

}  // namespace
}  // namespace flexura
