#include "flexura/report/image_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "flexura/report/chart.h"

namespace flexura {
namespace {

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
  // Columns 100 to 300, rows 100 to 200: an axis says so, the smaller rows first.
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

TEST(Chart, OverSomethingElseThanTimeInterruptsLinesAndDrawsDots) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  LineChart chart{"edges", "edges", "length (px)", "", 1, {}, "orbit (deg)"};
  chart.series.push_back({"top", "s0", {1, 2, none, 3, none, 4, 5}, {1, none, none, none, none, 4, none}});
  const Drawing drawing = chart_picture(chart, {0, 1, 2, 3, 4, 5, 6}, {});
  EXPECT_THAT(drawing.body, HasSubstr("orbit (deg)"));
  EXPECT_THAT(drawing.body, Not(HasSubstr("class=\"chart\""))) << "the page's script knows times only";
  EXPECT_EQ(count_of(drawing.body, "<circle"), 3U) << "two dots, and the value that stands alone";
  const std::size_t line = drawing.body.find("class=\"line s0\"");
  ASSERT_NE(line, std::string::npos);
  EXPECT_EQ(count_of(drawing.body.substr(line), "M"), 2U) << "two runs";
  EXPECT_THAT(drawing.body, Not(HasSubstr("nan")));
}

TEST(Chart, WithoutAnyNumberHasEmptyAxes) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  LineChart chart{"edges", "edges", "length (px)", "", 1, {}, "orbit (deg)"};
  chart.series.push_back({"top", "s0", {none, none}, {}});
  const Drawing drawing = chart_picture(chart, {0, 1}, {});
  EXPECT_THAT(drawing.body, Not(HasSubstr("nan")));
  EXPECT_THAT(drawing.body, Not(HasSubstr("line s0")));
}

}  // namespace
}  // namespace flexura
