#include "flexura/safety/violation_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace flexura {
namespace {

using testing::ElementsAre;

// One bend per second, the seventh the largest, and a contact.
SafetyReport swinging(std::size_t swings) {
  SafetyReport report;
  for (std::size_t k = 0; k < swings; ++k) {
    const auto start = static_cast<double>(k);
    report.violations.push_back({.hazard = Hazard::bend,
                                 .start = start,
                                 .end = start + 0.5,
                                 .worst_time = start + 0.25,
                                 .section = 0,
                                 .value = k == 6 ? 1.5 : 1.2,
                                 .limit = 1});
  }
  report.violations.push_back(
      {.hazard = Hazard::obstacle, .start = 2, .end = 3, .section = 0, .name = "lamp", .value = 0.01});
  report.sort();
  return report;
}

Violation touch(std::size_t first, std::size_t second, double depth) {
  return {.hazard = Hazard::self_contact,
          .end = 1,
          .worst_time = 1,
          .section = first,
          .other_section = second,
          .value = depth};
}

TEST(ViolationGroups, TellAgainAndAgainOnce) {
  EXPECT_THAT(violation_lines(swinging(600)),
              ElementsAre("0 s to 599.5 s, 600 times; worst at 6.25 s: section 1: bend 85.9437 deg, limit "
                          "57.2958 deg",
                          "2 s to 3 s: section 1: contact with lamp, 10 mm deep"));
  EXPECT_TRUE(violation_lines({}).empty());
}

TEST(ViolationGroups, TellWhichSectionsOneTouches) {
  SafetyReport report;
  for (const std::size_t other : {3U, 4U, 5U, 7U, 9U, 10U})
    report.violations.push_back(touch(1, other, 1e-3));
  report.violations.push_back(touch(2, 9, 1e-3));
  report.violations[4].value = 2e-3;
  EXPECT_THAT(
      violation_lines(report),
      ElementsAre("0 s to 1 s, 6 times, with sections 4 to 6, 8, 10 to 11; worst at 1 s: sections 2 and "
                  "10: contact with each other, 2 mm deep",
                  "0 s to 1 s: sections 3 and 10: contact with each other, 1 mm deep"));
}

TEST(ViolationGroups, KeepTheWorstOfEveryHazardWhenTheyAreTooMany) {
  SafetyReport report;
  for (std::size_t i = 0; i < 300; ++i)
    report.violations.push_back(touch(i, i + 20, 1e-5 * static_cast<double>(i)));
  report.violations.push_back({.hazard = Hazard::bend, .section = 7, .value = 1.1, .limit = 1});
  const auto lines = violation_lines(report);
  ASSERT_EQ(lines.size(), max_violation_lines + 1);
  EXPECT_EQ(lines.back(), "and 201 more groups of less severe violations");
  EXPECT_THAT(lines, testing::Contains(testing::HasSubstr("section 8: bend")));
  EXPECT_THAT(lines, testing::Contains(testing::HasSubstr("sections 300 and 320")));
  EXPECT_THAT(lines, testing::Not(testing::Contains(testing::HasSubstr("sections 1 and 21"))));
}

TEST(ViolationGroups, AreListedByTheirFirstAndWorst) {
  const SafetyReport report = swinging(600);
  EXPECT_THAT(listed_violations(report, grouped(report), 4), ElementsAre(0, 1, 3, 7));
  EXPECT_EQ(report.violations[7].value, 1.5);
  EXPECT_EQ(listed_violations(report, grouped(report), 10'000).size(), 601U);
}

}  // namespace
}  // namespace flexura
