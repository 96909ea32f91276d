#include "flexura/equipment/link_faults.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace flexura {
namespace {

constexpr int sent = 2000;

// Sends numbered messages, 1 ms apart, and returns what arrives.
std::vector<std::string> arrivals(const LinkFaults& faults) {
  FaultyCarrier carrier(5);
  std::vector<std::string> all;
  for (int i = 0; i < sent + 1000; ++i) {
    const double now = 1e-3 * i;
    if (i < sent) carrier.put(std::to_string(10000 + i), faults, now);
    for (std::string& one : carrier.take(now)) all.push_back(std::move(one));
  }
  return all;
}

// Bound on the difference of a share from its probability: six standard deviations.
const double spread = 6 * std::sqrt(0.25 / sent);

TEST(FaultyCarrier, WithoutFaultsCarriesAllInOrder) {
  const auto all = arrivals({});
  ASSERT_EQ(all.size(), std::size_t{sent});
  for (int i = 0; i < sent; ++i) EXPECT_EQ(all[static_cast<std::size_t>(i)], std::to_string(10000 + i));
}

TEST(FaultyCarrier, LosesAndRepeatsTheShareThatIsAskedFor) {
  EXPECT_NEAR(static_cast<double>(arrivals({.lose = 0.3}).size()) / sent, 0.7, spread);
  EXPECT_NEAR(static_cast<double>(arrivals({.repeat = 0.3}).size()) / sent, 1.3, spread);
  EXPECT_TRUE(arrivals({.lose = 1}).empty());
}

TEST(FaultyCarrier, CutsAndDamages) {
  int cut = 0, damaged = 0;
  for (const std::string& one : arrivals({.cut = 0.3})) cut += one.size() < 5;
  for (const std::string& one : arrivals({.damage = 0.3})) {
    EXPECT_EQ(one.size(), 5U);
    for (const char byte : one) damaged += byte < '0' || byte > '9';
  }
  EXPECT_NEAR(static_cast<double>(cut) / sent, 0.3, spread);
  // A changed byte may be another digit, or the same.
  EXPECT_NEAR(static_cast<double>(damaged) / sent, 0.3 * 246 / 256, spread);
}

TEST(FaultyCarrier, SwapsAndDelays) {
  for (const LinkFaults& faults : {LinkFaults{.swap = 0.2}, LinkFaults{.delay = 0.5, .most_late = 0.1}}) {
    const auto all = arrivals(faults);
    EXPECT_GE(all.size() + 1, std::size_t{sent});
    int out_of_order = 0;
    for (std::size_t i = 1; i < all.size(); ++i) out_of_order += all[i] < all[i - 1];
    EXPECT_GT(out_of_order, sent / 10);
  }
}

}  // namespace
}  // namespace flexura
