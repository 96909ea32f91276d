#include "flexura/report/axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace flexura {
namespace {

TEST(NiceTicks, AreWhatAPersonWouldChoose) {
  EXPECT_EQ(nice_ticks({0.0, 5.0}, 6).labels, (std::vector<std::string>{"0", "1", "2", "3", "4", "5"}));
  EXPECT_EQ(nice_ticks({-0.07, 0.31}, 5).labels, (std::vector<std::string>{"0.0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(nice_ticks({-11.5, 1.2}, 4).labels, (std::vector<std::string>{"-10", "-5", "0"}));
  EXPECT_EQ(nice_ticks({0.0, 2.4e7}, 3).labels, (std::vector<std::string>{"0", "1e+07", "2e+07"}));
}

TEST(NiceTicks, AreEvenStepsOfOneTwoOrFiveInsideTheRange) {
  const unsigned seed = 11;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> middle(-50.0, 50.0);
  std::uniform_real_distribution<double> power(-4.0, 8.0);
  for (int i = 0; i < 2000; ++i) {
    const double extent = std::pow(10.0, power(random));
    const double low = middle(random) - extent / 2;
    const int most = 2 + i % 9;
    SCOPED_TRACE(testing::Message() << low << " + " << extent << " in " << most);
    const Ticks ticks = nice_ticks({low, low + extent}, most);
    ASSERT_EQ(ticks.values.size(), ticks.labels.size());
    ASSERT_LE(ticks.values.size(), static_cast<std::size_t>(most));
    // Two steps of the next finer size would not fit: at least two fifths of the requested ticks exist.
    ASSERT_GE(static_cast<double>(ticks.values.size()), std::floor(0.4 * most));
    EXPECT_GE(ticks.values.front(), low);
    EXPECT_LE(ticks.values.back(), low + extent);
    EXPECT_EQ(std::set<std::string>(ticks.labels.begin(), ticks.labels.end()).size(), ticks.labels.size());
    if (ticks.values.size() < 3) continue;
    const double step = ticks.values[1] - ticks.values[0];
    EXPECT_NEAR(ticks.values[2] - ticks.values[1], step, 1e-9 * (step + std::abs(low)));
    const double digit = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-5 || std::abs(digit - 2) < 1e-5 || std::abs(digit - 5) < 1e-5)
        << digit;
  }
}

TEST(NiceTicks, NameTheirValues) {
  for (const double high : {1e-3, 0.4, 3.0, 77.0, 5e4, 3e9}) {
    const Ticks ticks = nice_ticks({-high / 3, high}, 7);
    for (std::size_t i = 0; i < ticks.values.size(); ++i) {
      EXPECT_NEAR(std::stod(ticks.labels[i]), ticks.values[i], 1e-9 * high);
    }
  }
}

TEST(Padded, GivesAnExtentToWhatHasNone) {
  for (const double value : {0.0, 1.0, -1e-12, 1e9, -1e15}) {
    const Interval range = padded({value, value}, 0.0, 0.05);
    EXPECT_LT(range.low, value);
    EXPECT_GT(range.high, value);
    EXPECT_GE(nice_ticks(range, 5).values.size(), 2u) << value;
  }
}

TEST(LineClass, IsAnotherForEachOf32Lines) {
  std::set<std::string> classes;
  for (std::size_t i = 0; i < 32; ++i) classes.insert(line_class(i));
  EXPECT_EQ(classes.size(), 32U);
}

TEST(PowerTicks, AreLabelledByTheNumbers) {
  const Ticks ticks = power_ticks({-3.2, 1.1}, 6);
  EXPECT_EQ(ticks.labels, (std::vector<std::string>{"0.001", "0.01", "0.1", "1", "10"}));
  EXPECT_EQ(power_ticks({-6, -4}, 6).labels, (std::vector<std::string>{"1e-06", "1e-05", "0.0001"}));
  for (const std::string& label : power_ticks({2.9, 3.4}, 6).labels)
    EXPECT_NE(label.find_first_of("0123456789"), std::string::npos);
}

}  // namespace
}  // namespace flexura
