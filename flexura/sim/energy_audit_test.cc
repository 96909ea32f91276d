#include "flexura/sim/energy_audit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexura {
namespace {

// A swing of 1 J whose total energy has these errors.
bool grows(double fluctuation, double growth, double dissipation) {
  EnergyAudit audit;
  for (int k = 0; k < 1000; ++k)
    audit.add(1 + fluctuation * std::sin(0.3 * k) + growth * k / 1000 - dissipation * k / 1000, 0.5);
  return audit.has_grown();
}

TEST(EnergyAudit, AllowsErrorsOfSteps) {
  EXPECT_FALSE(grows(0, 0, 0));
  EXPECT_FALSE(grows(0.05, 0, 0));
  EXPECT_FALSE(grows(0.05, 0, 0.9));
}

TEST(EnergyAudit, FindsGrowth) {
  EXPECT_TRUE(grows(0, 0.2, 0));
  EXPECT_TRUE(grows(0.05, 0.5, 0));
}

// Energy that is supplied between two spans is no growth.
TEST(EnergyAudit, ComparesWithinASpan) {
  EnergyAudit audit;
  for (int span = 0; span < 10; ++span) {
    for (int k = 0; k < 10; ++k) audit.add(span, 0.1);
    EXPECT_FALSE(audit.has_grown());
    audit.restart();
  }
  audit.add(10, 0.1), audit.add(11, 0.1);
  EXPECT_TRUE(audit.has_grown());
  audit.restart(), audit.add(0, 1);
  EXPECT_TRUE(audit.has_grown());
}

}  // namespace
}  // namespace flexura
