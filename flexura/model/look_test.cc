#include "flexura/model/look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flexura/base/reader.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

Arm arm_of(const std::vector<double>& lengths) {
  Arm arm;
  for (const double length : lengths) arm.sections.push_back({.length = length});
  return arm;
}

std::vector<std::string> problems_of(const LookConfig& look, const Arm& arm) {
  Reader reader;
  check_look(look, arm, "look", reader);
  std::vector<std::string> texts;
  for (const Problem& problem : reader.problems()) texts.push_back(problem.what);
  return texts;
}

TEST(Look, PlacesBandsAlongEverySectionTheLastOneAtItsEnd) {
  LookConfig look;
  look.bands = MarkerBands{.per_section = 2, .width = 0.1, .colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  look.marker.push_back({.at = 0.25, .width = 0.2, .color = {1, 1, 1}});
  const std::vector<Marker> markers = look.markers(arm_of({1, 2}));
  ASSERT_EQ(markers.size(), 5U);
  const double ends[] = {0.35, 0.5, 1, 2, 3};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(markers[i].at + markers[i].width / 2, ends[i]) << i;
  EXPECT_EQ(markers[0].color, (ColorConfig{1, 1, 1}));
  EXPECT_EQ(markers[1].color, (ColorConfig{1, 0, 0}));
  EXPECT_EQ(markers[4].color, (ColorConfig{1, 0, 0}));
  EXPECT_TRUE(problems_of(look, arm_of({1, 2})).empty());
}

TEST(Look, TellsWhatDoesNotLieOnTheArm) {
  LookConfig look;
  look.marker = {{.at = 0.5, .width = 0.1}, {.at = 2.99, .width = 0.1}};
  look.disk = {{.at = 0}};
  EXPECT_THAT(problems_of(look, arm_of({1, 2})),
              testing::ElementsAre(testing::HasSubstr("look.marker[1]: is not on the arm"),
                                   testing::HasSubstr("look.disk[0]: is not on the arm")));
}

TEST(Look, TellsMarkersThatLieOneUponTheOther) {
  LookConfig look;
  look.marker = {{.at = 0.5, .width = 0.1}, {.at = 0.55, .width = 0.1}};
  EXPECT_THAT(problems_of(look, arm_of({1, 2})),
              testing::ElementsAre(testing::HasSubstr("has markers at 0.5 m and 0.55 m that overlap")));
  look.marker = {{.at = 0.5, .width = 0.1}, {.at = 0.6, .width = 0.1}};
  EXPECT_TRUE(problems_of(look, arm_of({1, 2})).empty());
}

}  // namespace
}  // namespace flexura
