#include "flexura/report/image_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "flexura/report/chart.h"

namespace flexura {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

ImagePlot plot_with(const std::vector<Eigen::Vector2d>& points) {
  return {"heading", "orbit", 640, 480, {{"20 deg", "s1", {{points, "dash2"}}}}};
}

TEST(ImagePicture, DrawsItsLinesWithRowsDownwards) {
  const Drawing drawing = image_picture(plot_with({{100, 100}, {300, 100}, {300, 200}, {100, 100}}));
  EXPECT_THAT(drawing.body, HasSubstr("20 deg"));
  EXPECT_THAT(drawing.body, HasSubstr("class=\"line s1 dash2\""));
  // Columns 100 to 300, rows 100 to 200: an axis must show them, the smaller rows first.
  EXPECT_THAT(drawing.body, HasSubstr(">300</text>"));
  const auto height_of = [&](const std::string& row) {
    const std::size_t text = drawing.body.find("class=\"tick end\">" + row + "</text>");
    EXPECT_NE(text, std::string::npos) << row;
    const std::size_t y = drawing.body.rfind(" y=\"", text);
    return std::stod(drawing.body.substr(y + 4));
  };
  EXPECT_LT(height_of("120"), height_of("180"));
  EXPECT_GT(drawing.height, 300);
}

TEST(ImagePicture, KeepsToTheImageWhateverItShows) {
  for (const auto& points : std::vector<std::vector<Eigen::Vector2d>>{
           {}, {{-1e9, 0}, {1e9, 5}}, {{5000, 5000}, {5001, 5000}}, {{10, 10}}}) {
    const Drawing drawing = image_picture(plot_with(points));
    EXPECT_THAT(drawing.body, Not(HasSubstr("nan")));
    EXPECT_THAT(drawing.body, Not(HasSubstr("inf")));
    EXPECT_GT(drawing.height, 100);
    EXPECT_LT(drawing.height, 700);
  }
}

TEST(Chart, InterruptsLinesAndDrawsDotsAndRings) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  LineChart chart{.heading = "edges", .x_label = "orbit (deg)", .value_label = "length (px)"};
  chart.x = {0, 1, 2, 3, 4, 5, 6}, chart.marks = {2.5};
  chart.series.push_back({.name = "top",
                          .values = {1, 2, none, 3, none, 4, 5},
                          .dots = {1, none, none, none, none, 4, none},
                          .rings = {none, 2, none, none, none, none, none}});
  const std::string body = chart_picture(chart).body;
  EXPECT_THAT(body, HasSubstr("orbit (deg)"));
  EXPECT_EQ(count_of(body, "class=\"dot "), 3U) << "two dots, and the value that stands alone";
  EXPECT_EQ(count_of(body, "class=\"ring "), 1U);
  EXPECT_EQ(count_of(body, "class=\"event\""), 1U);
  const std::size_t line = body.find("class=\"line s0 dash0\"");
  ASSERT_NE(line, std::string::npos);
  EXPECT_EQ(count_of(body.substr(line), "M"), 2U) << "two runs";
  chart.series[0].values = {none, none, none, none, none, none, none};
  chart.series[0].dots = chart.series[0].rings = {};
  EXPECT_THAT(chart_picture(chart).body, AllOf(Not(HasSubstr("line s0")), Not(HasSubstr("nan"))))
      << "empty axes";
}

}  // namespace
}  // namespace flexura
