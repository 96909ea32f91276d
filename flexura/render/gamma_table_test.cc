#include "flexura/render/gamma_table.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

int closed_form(float x, double gamma, int top) {
  return static_cast<int>(std::floor(top * std::pow(static_cast<double>(x), 1 / gamma) + 0.5));
}

TEST(GammaTable, IsTheClosedFormAtEveryLevelAndAtRandom) {
  for (const int bits : {1, 8, 12, 16}) {
    for (const double gamma : {0.1, 0.45, 1.0, 2.2, 10.0}) {
      const int top = (1 << bits) - 1;
      const GammaTable table(gamma, top);
      for_random_cases(2000, [&](TestRandom& random) {
        const auto even = static_cast<float>(random.uniform(0, 1));
        const auto dark = static_cast<float>(std::exp2(random.uniform(-100, 0)));
        const auto level = random.integer(0, top - 1);
        const auto edge = static_cast<float>(std::pow((level + 0.5) / top, gamma));
        for (const float x : {even, dark, edge, std::nextafter(edge, 0.0f)})
          EXPECT_EQ(table.level(x), closed_form(x, gamma, top)) << x << " " << gamma << " " << top;
      });
      EXPECT_EQ(table.level(0), 0);
      EXPECT_EQ(table.level(1), top);
    }
  }
}

TEST(GammaTable, NeverFalls) {
  const GammaTable table(2.2, 255);
  int level = 0;
  for (std::uint32_t bits = 0; bits <= std::bit_cast<std::uint32_t>(1.0f); bits += 4099) {
    const int next = table.level(std::bit_cast<float>(bits));
    ASSERT_GE(next, level);
    level = next;
  }
  EXPECT_GE(level, 254);
}

}  // namespace
}  // namespace flexura
