#include "tests/support/study_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/random_cases.h"
#include "tests/support/spread_tables.h"

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

TEST(StudyNumbers, AnAimIsOfAllTrialsAndNotOfThoseThatEnded) {
  const Aim all{"within 2 %", 0.02, 0.01, {-0.02, 0.01, none}}, share{"", 0.02, 0.01, {-0.02, 0.01}, 2.0 / 3};
  EXPECT_EQ(aim_row("a", all, 2), "| a | within 2 % | 2 of 2 | met | met (1.581) | 2 |\n");
  EXPECT_EQ(aim_row("a", all, 3), "| a | within 2 % | 2 of 3 | missed | met (1.581) | 2 |\n");
  EXPECT_EQ(aim_row("", share, 3), "|  |  | 2 of 3 | met | met (1.581) | 2 |\n");
  EXPECT_EQ(aim_row("", share, 4), "|  |  | 2 of 4 | missed | met (1.581) | 2 |\n");
  const Aim one{"", 0.02, 0.01, {0.03}, 1, false}, nothing{"", 0.02, 0.01, {}};
  EXPECT_EQ(aim_row("", one, 1), "|  |  | 0 of 1 | missed |  | 3 |\n");
  EXPECT_EQ(aim_row("", nothing, 1), "|  |  | 0 of 1 | missed | not tested () |  |\n");
  EXPECT_EQ(aim_row("", nothing, 0), "|  |  | 0 of 0 | not tested | not tested () |  |\n");
}

TEST(StudyNumbers, ASpreadIsOfSizes) {
  EXPECT_EQ(spread_row("a", {-3, 1}, 0.5, 1), "| a | 4.5 | 6.0 | 6.0 |\n");
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
