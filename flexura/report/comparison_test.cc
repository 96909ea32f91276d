#include "flexura/report/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(OverlaidChart, InterpolatesBothRunsAtCommonTimes) {
  const LineChart chart = overlaid_chart("tip", "X (m)", 1, {{0, 2}, {0, 4}}, {{0, 1, 3}, {1, 2, 0}});
  EXPECT_EQ(chart.x, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_DOUBLE_EQ(chart.series[0].values[1], 2);
  EXPECT_TRUE(std::isnan(chart.series[0].values[3]));
  EXPECT_DOUBLE_EQ(chart.series[1].values[2], 1);
  EXPECT_THROW((void)overlaid_chart("", "", 1, {}, {}), std::invalid_argument);
}

TEST(OverlaidChart, OfLongRunsIsThinned) {
  TimedValues a;
  for (int i = 0; i < 10000; ++i) a.times.push_back(0.01 * i), a.values.push_back(i);
  const LineChart chart = overlaid_chart("", "", 1, a, {});
  EXPECT_EQ(chart.x.size(), 2000U);
  EXPECT_NEAR(chart.series[0].values[1000], 100 * chart.x[1000], 1e-6);
}

TEST(ComparisonHtml, ShowsTextsAndLoadsNothing) {
  const std::string html = comparison_html(
      {.a = "<a>",
       .b = "b",
       .headline_a = "done & dusted",
       .headline_b = "",
       .version = "1",
       .notes = {"a note"},
       .table = {{"measure", "A", "B"}, {{"rms < 1", "1", "2"}}},
       .figures = {{"tip-x", overlaid_chart("tip", "X (m)", 1, {{0, 1}, {0, 1}}, {{0, 1}, {1, 0}})}}});
  for (const char* part : {"&lt;a&gt; and b", "done &amp; dusted", "<td>rms &lt; 1</td>",
                           "<figure id=\"picture-tip-x\">", "default-src 'none'", "a note"})
    EXPECT_THAT(html, HasSubstr(part));
  for (const char* part : {"<script", " src=", "url(", "href=\"http", "style=\"", "nan"})
    EXPECT_THAT(html, Not(HasSubstr(part)));
}

}  // namespace
}  // namespace flexura
