#include "flexura/report/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace flexura {
namespace {

TEST(Filled, PutsValuesInAndLooksAtThemOnlyOnce) {
  EXPECT_EQ(filled("<a>{{x}}</a>{{y}}{{x}}.", {{"x", "{{y}}"}, {"y", "2"}}), "<a>{{y}}</a>2{{y}}.");
  EXPECT_EQ(filled("nothing", {}), "nothing");
  EXPECT_THROW((void)filled("{{z}}", {{"x", ""}}), std::out_of_range);
}

TEST(CspHash, IsTheHashInBase64) {
  // SHA-256 of an empty text.
  EXPECT_EQ(csp_hash("e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"),
            "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='");
}

TEST(MotionJson, HoldsNumbersOnly) {
  ReportData data;
  data.arm.kind = ArmKind::spatial;
  data.arm.sections.resize(1);
  data.times = {0.0, 0.5};
  data.states = {ArmState::straight(1), {{{0.25, -1.0 / 3.0}}, {1.0}}};
  const std::string json = motion_json(motion_of(data));
  EXPECT_NE(json.find("\"states\":[0,0,1,0.25,-0.333333333,1]"), std::string::npos) << json;
}

TEST(FigureHtml, HoldsAChartsTextsEscapedAndItsNumbers) {
  LineChart chart{.heading = "<h>", .x_label = "\"x\"", .value_label = "y", .x = {0, 1}, .marks = {0.5}};
  chart.series = {{.name = "</script>", .values = {1.0 / 3, std::nan("")}, .rings = {std::nan(""), 2}}};
  const std::string html = figure_html({"a", chart});
  for (const char* part : {"<figure id=\"picture-a\">", "<figcaption>&lt;h&gt;", "data-x=\"&quot;x&quot;\"",
                           "<li class=\"s0 dash0\">&lt;/script&gt;</li>",
                           R"({"x":[0,1],"marks":[0.5],"series":[[[0.333333,null],[],[null,2]]]}</script>)"})
    EXPECT_NE(html.find(part), std::string::npos) << part << " in " << html;
  chart.is_of_run = true;
  EXPECT_NE(figure_html({"a", chart}).find("{\"x\":null,"), std::string::npos)
      << "the page has the run's times";
}

}  // namespace
}  // namespace flexura
