#include "flexura/report/svg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace flexura {
namespace {

TEST(XmlEscape, LeavesNoMarkup) {
  EXPECT_EQ(xml_escape("<a href=\"x\">'&amp;' ]]></a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;amp;&#39; ]]&gt;&lt;/a&gt;");
}

TEST(XmlEscape, KeepsGoodUtf8) {
  const std::string text = "\xC3\xA9 \xE2\x86\x92 \xF0\x9F\x90\x99\n\t";
  EXPECT_EQ(xml_escape(text), text);
}

TEST(XmlEscape, ReplacesWhatIsNotUtf8OrNotXml) {
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(xml_escape("a\x01z"), "a" + bad + "z");
  EXPECT_EQ(xml_escape(std::string_view("\0", 1)), bad);
  EXPECT_EQ(xml_escape("\xFFz"), bad + "z");
  EXPECT_EQ(xml_escape("\xC3"), bad) << "cut off";
  EXPECT_EQ(xml_escape("\xC0\xBC"), bad + bad) << "an overlong <";
  EXPECT_EQ(xml_escape("\xED\xA0\x80"), bad + bad + bad) << "a surrogate";
  EXPECT_EQ(xml_escape("\xEF\xBF\xBF"), bad);
}

TEST(PageNumber, IsShortAndHasNoNegativeZero) {
  EXPECT_EQ(page_number(12.5), "12.5");
  EXPECT_EQ(page_number(120.0), "120");
  EXPECT_EQ(page_number(-0.0001), "0");
  EXPECT_EQ(page_number(1.0 / 3.0), "0.333");
  EXPECT_EQ(fixed(-0.0004, 3), "0.000");
  EXPECT_EQ(fixed(-10.7378590, 3), "-10.738");
}

TEST(Simplified, KeepsEveryPointWithinTheTolerance) {
  const unsigned seed = 7;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jump(-1.0, 1.0);
  std::vector<Eigen::Vector2d> points = {{0.0, 0.0}};
  for (int i = 1; i < 400; ++i) points.emplace_back(i, points.back().y() + jump(random));
  const double tolerance = 0.7;
  const std::vector<Eigen::Vector2d> kept = simplified(points, tolerance);
  EXPECT_LT(kept.size(), points.size() / 2);
  EXPECT_EQ(kept.front(), points.front());
  EXPECT_EQ(kept.back(), points.back());
  std::size_t span = 0;
  for (const Eigen::Vector2d& point : points) {
    while (point.x() > kept[span + 1].x()) ++span;
    const Eigen::Vector2d chord = (kept[span + 1] - kept[span]).normalized();
    const Eigen::Vector2d offset = point - kept[span];
    EXPECT_LE(std::abs(chord.x() * offset.y() - chord.y() * offset.x()), tolerance);
  }
}

TEST(Simplified, MakesAStraightLineItsTwoEnds) {
  EXPECT_EQ(simplified({{0, 0}, {1, 1}, {2, 2}, {5, 5}}, 0.05).size(), 2u);
  EXPECT_EQ(simplified({{3, 3}, {3, 3}, {3, 3}}, 0.05).size(), 2u);
  EXPECT_EQ(simplified({{3, 3}}, 0.05).size(), 1u);
}

TEST(Simplified, SeesAPathThatReturnsToItsStart) {
  EXPECT_EQ(simplified({{0, 0}, {5, 0}, {0, 0}}, 0.05).size(), 3u);
}

TEST(XmlWriter, ClosesWhatIsOpenAndEscapes) {
  XmlWriter writer;
  writer.open("g", {{"class", "a\"b"}});
  writer.leaf("path", {{"d", "M0 0"}});
  writer.label({1.0, 2.0}, "end", "a<b");
  EXPECT_EQ(
      writer.text(),
      "<g class=\"a&quot;b\"><path d=\"M0 0\"/>\n<text x=\"1\" y=\"2\" class=\"end\">a&lt;b</text>\n</g>\n");
}

}  // namespace
}  // namespace flexura
