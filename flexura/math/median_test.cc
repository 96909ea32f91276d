#include "flexura/math/median.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(Median, IsTheMiddleOneOfTheSorted) {
  for_random_cases(100, [](TestRandom& random) {
    std::vector<double> values;
    for (int i = random.integer(1, 12); i > 0; --i) values.push_back(random.integer(-3, 3));
    std::vector<double> sorted = values;
    std::ranges::sort(sorted);
    EXPECT_EQ(median(std::span(values)), sorted[sorted.size() / 2]);
    std::ranges::sort(values);
    EXPECT_EQ(values, sorted) << "none is lost";
  });
}

}  // namespace
}  // namespace flexura
