#include "flexura/safety/violation.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace flexura {
namespace {

Violation violation(Hazard hazard, double worst_time, double value, std::optional<std::size_t> section,
                    const char* name = "") {
  return {.hazard = hazard,
          .worst_time = worst_time,
          .section = section,
          .name = name,
          .value = value,
          .limit = 1};
}

TEST(MostRelevant, IsAMotorsAfterThoseOfSectionsThoughItHasOne) {
  SafetyReport report;
  report.violations = {violation(Hazard::motor_speed, 1, 9, 0, "1.1"),
                       violation(Hazard::step_rate, 2, 9, 0, "1.1"), violation(Hazard::bend, 3, 2, 0),
                       violation(Hazard::stretch, 4, 2, 0)};
  EXPECT_EQ(most_relevant(report, 2), (std::vector<std::size_t>{2, 3}));
}

TEST(MostRelevant, AreTheWorstOfEveryHazardAndObstacleAndThoseOfSectionsFirst) {
  SafetyReport report;
  report.violations = {violation(Hazard::bend, 1, 2, 0),
                       violation(Hazard::bend, 2, 3, 1),
                       violation(Hazard::motor_speed, 3, 2, {}, "1.1"),
                       violation(Hazard::obstacle, 4, 2, 0, "table"),
                       violation(Hazard::obstacle, 5, 2, 0, "lamp"),
                       violation(Hazard::stretch, 6, 0.5, 0),
                       violation(Hazard::stretch, 7, 0.7, 1)};
  using Places = std::vector<std::size_t>;
  EXPECT_EQ(most_relevant(report, 4), (Places{1, 2, 3, 5})) << "every hazard before a second obstacle";
  EXPECT_EQ(most_relevant(report, 5), (Places{1, 2, 3, 4, 5}));
  EXPECT_EQ(most_relevant(report, 6), (Places{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(most_relevant(report, 99).size(), 7U);
  report.violations[4].worst_time = 4;
  EXPECT_EQ(most_relevant(report, 4), (Places{1, 2, 3, 5})) << "one picture of one moment";
  EXPECT_TRUE(most_relevant({}, 4).empty());
}

}  // namespace
}  // namespace flexura
