#include "flexura/report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

namespace flexura {
namespace {

// Returns the paper's arm (section 3.2), straight and then bent linearly to its final archings within 5 s.
ReportData paper_run(std::size_t steps) {
  const double lengths[] = {2, 3, 1, 2, 4, 2, 1, 1};
  const double archings_pi[] = {0.05, 0.05, 0.1, 0.1, 0.05, -0.3, 0.2, -0.35};
  ReportData data;
  data.title = "The paper's arm";
  data.version = "0.1.0";
  data.experiment_text = "[arm]\n";
  for (const double length : lengths) data.arm.sections.emplace_back().length = length;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double part = steps == 0 ? 0.0 : static_cast<double>(i) / static_cast<double>(steps);
    ArmState state = ArmState::straight(8);
    for (std::size_t k = 0; k < 8; ++k) state.bends[k].x() = -2 * std::numbers::pi * archings_pi[k] * part;
    data.times.push_back(5.0 * part);
    data.states.push_back(state);
  }
  data.events = {{0.0, "start", "task 1"}, {5.0 * static_cast<double>(steps > 0), "end", "task 1"}};
  return data;
}

ReportData spatial_run() {
  ReportData data;
  data.title = "spatial";
  data.arm.kind = ArmKind::spatial;
  data.arm.sections.resize(3);
  data.arm.sections[1].radius = {0.05, 0.01};
  for (int i = 0; i <= 50; ++i) {
    const double angle = 0.1 * i;
    ArmState state = ArmState::straight(3);
    for (Eigen::Vector2d& bend : state.bends) bend = {angle * std::cos(angle), angle * std::sin(angle)};
    state.stretches[2] = 1.0 + 0.01 * i;
    data.times.push_back(0.1 * i);
    data.states.push_back(state);
  }
  return data;
}

std::set<std::string> names_of(const std::vector<FigureFile>& figures) {
  std::set<std::string> names;
  for (const FigureFile& figure : figures) names.insert(figure.file_name);
  return names;
}

const std::string& svg_of(const std::vector<FigureFile>& figures, const std::string& name) {
  for (const FigureFile& figure : figures) {
    if (figure.file_name == name) return figure.svg;
  }
  throw std::out_of_range(name);
}

// Returns an error in the nesting, the attributes' quotes or the references of an XML text, or "".
std::string xml_fault(std::string_view xml) {
  std::vector<std::string> open;
  while (!xml.empty()) {
    const std::size_t bracket = xml.find('<');
    const std::string_view content = xml.substr(0, bracket);
    if (content.find('>') != std::string_view::npos) return "a loose >";
    for (std::size_t at = content.find('&'); at != std::string_view::npos; at = content.find('&', at + 1)) {
      const std::string_view name = content.substr(at + 1, content.find(';', at) - at - 1);
      if (!std::set<std::string_view>{"amp", "lt", "gt", "quot", "#39"}.contains(name)) return "a loose &";
    }
    if (bracket == std::string_view::npos) break;
    const std::size_t close = xml.find('>', bracket);
    if (close == std::string_view::npos) return "a tag without an end";
    const std::string_view tag = xml.substr(bracket + 1, close - bracket - 1);
    xml.remove_prefix(close + 1);
    if (std::ranges::count(tag, '"') % 2 != 0 || tag.find('<') != std::string_view::npos) return "a bad tag";
    const std::string name(tag.substr(0, tag.find_first_of(" /", 1)));
    if (tag.front() == '/') {
      if (open.empty() || "/" + open.back() != name) return "</> closes another element: " + name;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "not closed: " + open.back();
}

std::size_t times_in(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::size_t warnings_in(const std::string& svg) { return times_in(svg, "class=\"warning\""); }

TEST(Report, DrawsAWarningAroundWhatIsUnsafeWhileItIs) {
  ReportData data = paper_run(50);
  EXPECT_EQ(report_html(data).find("safety-title"), std::string::npos);
  data.safety = {.violations = {{.start = 4.0, .end = 5.0, .sections = {1, 6}, .text = "both"}},
                 .lines = {{.start = 4.0, .text = "section 2 < 7"}},
                 .remarks = {"a note"}};
  const std::string html = report_html(data);
  for (const char* part : {"section 2 &lt; 7", "<li>a note</li>", R"("unsafe":[[4,5,1],[4,5,6]])"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  const std::vector<FigureFile> figures = report_figures(data);
  EXPECT_EQ(warnings_in(svg_of(figures, "arm-start.svg")), 0U);
  const std::string& end = svg_of(figures, "arm-end.svg");
  EXPECT_EQ(warnings_in(end), 2U);
  // Between the border and a tube as red as the border there is a gap, drawn after the border and before the
  // tube.
  const std::size_t border = end.find("class=\"warning\"");
  const std::size_t gap = end.find("class=\"gap\"", border);
  EXPECT_LT(gap, end.find("class=\"tube s1\"", border));
  EXPECT_EQ(svg_of(figures, "arm-start.svg").find("class=\"gap"), std::string::npos);
}

TEST(Report, DrawsViolationsAtTheirWorstMoments) {
  ReportData data = paper_run(50'000);
  data.safety = {
      .violations = {{.start = 1, .end = 2, .sections = {3}, .text = "no picture of its own"},
                     {.start = 3.1, .end = 3.2, .sections = {2}, .text = "3 < 4", .pictured_at = 3.12345},
                     {.start = 6, .end = 6, .sections = {5}, .text = "after the end", .pictured_at = 6}},
      .lines = {},
      .remarks = {}};
  data.times.insert(data.times.begin() + 31235, 3.12345);
  data.states.insert(data.states.begin() + 31235, data.states[31235]);
  const std::string html = report_html(data);
  const std::string caption =
      R"(<figcaption><button type="button" class="jump" data-time="3.12345">3.123</button> 3 &lt; 4</figcaption>)";
  EXPECT_NE(html.find(caption), std::string::npos);
  EXPECT_NE(html.find(",3.12345,"), std::string::npos) << "the player's times";
  EXPECT_EQ(report_html(paper_run(10)).find("worst moment"), std::string::npos);
  const std::vector<FigureFile> figures = report_figures(data);
  EXPECT_FALSE(names_of(figures).contains("arm-unsafe-3.svg"));
  const std::string& first = svg_of(figures, "arm-unsafe-1.svg");
  EXPECT_EQ(xml_fault(first), "");
  EXPECT_EQ(warnings_in(first), 1U);
  EXPECT_NE(first.find("worst moment, t = 3.123 s"), std::string::npos);
  EXPECT_EQ(warnings_in(svg_of(figures, "arm-unsafe-2.svg")), 1U) << "outside its span, too";
}

TEST(Report, DrawsWhatIsWorstAtOneMomentInOnePicture) {
  ReportData data = paper_run(50);
  const double when = data.times[20];
  data.safety = {
      .violations = {{.start = when, .end = 5, .sections = {3}, .text = "one", .pictured_at = when},
                     {.start = when, .end = 5, .sections = {4}, .text = "other", .pictured_at = when}},
      .lines = {},
      .remarks = {}};
  const std::vector<FigureFile> figures = report_figures(data);
  EXPECT_FALSE(names_of(figures).contains("arm-unsafe-2.svg"));
  EXPECT_EQ(warnings_in(svg_of(figures, "arm-unsafe-1.svg")), 2U);
  EXPECT_NE(report_html(data).find("</button> one; other</figcaption>"), std::string::npos);
}

TEST(Report, DrawsTheTargetsThatTheTipMisses) {
  ReportData data = paper_run(50);
  const double end = data.times.back();
  const Eigen::Vector3d beside =
      Backbone(data.arm, data.states.back()).tip().position + Eigen::Vector3d(1, 1, 0);
  data.safety = {.violations = {{.start = end,
                                 .end = end,
                                 .sections = {},
                                 .text = "beside",
                                 .pictured_at = end,
                                 .target = beside}},
                 .lines = {},
                 .remarks = {}};
  const std::vector<FigureFile> figures = report_figures(data);
  for (const char* name : {"arm-unsafe-1.svg", "arm-end.svg"}) {
    EXPECT_EQ(xml_fault(svg_of(figures, name)), "");
    EXPECT_EQ(times_in(svg_of(figures, name), "class=\"target\""), 1U) << name;
    EXPECT_EQ(times_in(svg_of(figures, name), "class=\"target-way\""), 1U) << name;
  }
  EXPECT_EQ(times_in(svg_of(figures, "arm-start.svg"), "class=\"target"), 0U) << "not its time";
  // Start, middle, end, worst and player: crosses in three of them.
  EXPECT_EQ(times_in(report_html(data), "class=\"target\""), 3U);
  // A distant target must not make the arm small: the line to it ends at the border.
  data.safety->violations[0].target = Eigen::Vector3d(0, 1e5, 0);
  const std::string far = svg_of(report_figures(data), "arm-unsafe-1.svg");
  EXPECT_EQ(times_in(far, "class=\"target\""), 0U);
  EXPECT_EQ(times_in(far, "class=\"target-way\""), 1U);
}

TEST(Report, HasAChapterForWhatWasMeasuredBesideTheMotion) {
  ReportData data = paper_run(10);
  EXPECT_EQ(report_html(data).find("chapter-1"), std::string::npos);
  data.chapters = {{"Study: <a>", "1 < 2", {{"a-edges", Drawing{100, 50, "a label", "<g></g>\n"}}}}};
  const std::string html = report_html(data);
  for (const char* part :
       {"<h2 id=\"chapter-1\">Study: &lt;a&gt;</h2>", "<p>1 &lt; 2</p>", "<figure id=\"picture-a-edges\">"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(xml_fault(svg_of(report_figures(data), "a-edges.svg")), "");
}

TEST(Report, HasTablesAndFoldedListsInChapters) {
  ReportData data = paper_run(10);
  data.chapters = {{.heading = "Calibration",
                    .text = "text",
                    .figures = {},
                    .table = ChapterTable{{"quantity", "reached"}, {{"angle < 1", "yes"}}},
                    .details = {"What is unknown", {"a & b"}}}};
  const std::string html = report_html(data);
  for (const char* part :
       {"<th scope=\"col\">quantity</th><th scope=\"col\">reached</th>",
        "<tr><td>angle &lt; 1</td><td>yes</td></tr>",
        "<details><summary>What is unknown</summary>\n<ul>\n<li>a &amp; b</li>\n</ul>\n</details>"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(Report, BeginsWithWhatCameOfTheRun) {
  ReportData data = paper_run(10);
  EXPECT_EQ(report_html(data).find("class=\"outcome\""), std::string::npos);
  data.headline = "1 of 2 done", data.outcomes = {{"<a>", "there", true}, {"b", "not begun", false}};
  const std::string html = report_html(data);
  for (const char* part :
       {"<p class=\"outcome\">1 of 2 done</p>", "<li><strong>&lt;a&gt;</strong> there</li>",
        "<li class=\"missed\"><strong>b</strong> not begun</li>"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(Report, LinksToItsParts) {
  ReportData data = spatial_run();
  data.chapters = {{"Servo: <bow>", "text", {}}};
  const std::string html = report_html(data);
  std::size_t links = 0;
  for (std::size_t at = html.find("<a href=\"#"); at != std::string::npos;
       at = html.find("<a href=\"#", at + 1), ++links) {
    const std::size_t begin = at + 10;
    const std::string id = html.substr(begin, html.find('"', begin) - begin);
    EXPECT_NE(html.find("id=\"" + id + "\""), std::string::npos) << id;
  }
  EXPECT_EQ(links, 7U);
  EXPECT_NE(html.find(">Servo: &lt;bow&gt;</a>"), std::string::npos);
}

TEST(Report, HidesWhatNeverChanges) {
  ReportData data = spatial_run();
  for (ArmState& state : data.states)
    for (Eigen::Vector2d& bend : state.bends) bend.y() = 0;
  const std::string moving = report_html(data);
  EXPECT_EQ(moving.find("picture-bends-y"), std::string::npos);
  EXPECT_NE(moving.find("picture-bends-x"), std::string::npos);
  EXPECT_NE(moving.find("Not shown, because it does not change: bend_y of each section."), std::string::npos);
  for (ArmState& state : data.states) state = data.states.front();
  data.safety = {.violations = {}, .lines = {{.start = 1, .text = "line"}}, .remarks = {}};
  data.events = {{1, "start", "hold"}};
  const std::string still = report_html(data);
  for (const char* part :
       {"id=\"picture-tip", "picture-bends", "picture-arm-middle", "class=\"jump\"", "href=\"#player"})
    EXPECT_EQ(still.find(part), std::string::npos) << part;
  EXPECT_NE(still.find("The arm, which does not move"), std::string::npos);
  EXPECT_NE(still.find("\"still\":true"), std::string::npos);
  EXPECT_TRUE(names_of(report_figures(data)).contains("tip.svg")) << "the files are complete";
}

TEST(Report, DrawsObstaclesInEveryPictureOfTheArm) {
  ReportData data = spatial_run();
  data.obstacles = {PlaneConfig{.name = "ground <"},
                    PlaneConfig{.name = "slope", .normal = {1, 1, 1}},  // Not edge-on in any view.
                    SphereConfig{.center = {0.1, 0, 0}, .radius = 0.1},
                    CapsuleConfig{.name = "rod", .from = {0, 0, 0}, .to = {0, 0.2, 0}, .radius = 0.05},
                    BoxConfig{.name = "desk", .center = {0, 0.1, 0}, .half_sizes = {0.1, 0.2, 0.3}}};
  const std::vector<FigureFile> figures = report_figures(data);
  for (const char* name : {"arm-start.svg", "arm-middle.svg", "arm-end.svg"}) {
    const std::string& svg = svg_of(figures, name);
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    for (const char* title : {"ground &lt;", "sphere 3", "rod", "desk"})
      EXPECT_NE(svg.find("<title>" + std::string(title)), std::string::npos) << title;
    EXPECT_EQ(svg.find("<title>slope"), std::string::npos);
  }
  EXPECT_NE(report_html(data).find("<title>desk</title>"), std::string::npos);
  EXPECT_EQ(svg_of(figures, "tip.svg").find("class=\"obstacle\""), std::string::npos);
}

TEST(Report, DrawsTheChosenCurveAlongTheArm) {
  ReportData data = paper_run(20);
  EXPECT_EQ(svg_of(report_figures(data), "arm-end.svg").find("class=\"spline\""), std::string::npos);
  for (const CurveKind kind : {CurveKind::catmull_rom, CurveKind::bezier}) {
    data.curve = kind;
    const std::string svg = svg_of(report_figures(data), "arm-end.svg");
    const std::size_t line = svg.find("class=\"spline\"");
    ASSERT_NE(line, std::string::npos);
    const std::string path = svg.substr(line, svg.find("/>", line) - line);
    EXPECT_EQ(std::ranges::count(path, 'C'), 8) << path;  // One cubic per section.
    EXPECT_EQ(xml_fault(svg), "");
    const std::string html = report_html(data);
    // The paper's spline through its arm's base points: docs/kinematic-model.md.
    EXPECT_NE(html.find(kind == CurveKind::bezier ? "at most 0.0" : "2.7 % shorter"), std::string::npos);
  }
}

TEST(Report, CountsItsDurationFromWhereItBegins) {
  ReportData data = paper_run(10);
  for (double& time : data.times) time += 3;
  const std::string html = report_html(data);
  EXPECT_NE(html.find("<dt>duration</dt><dd>5.000 s</dd>"), std::string::npos);
  EXPECT_NE(html.find("end <small>t = 8.000 s</small>"), std::string::npos);
}

TEST(Report, DrawsAPlaneWhereItCutsThePlaneOfTheArm) {
  ReportData data = paper_run(10);
  data.obstacles = {PlaneConfig{.name = "slope", .normal = {1, 1, 1}},
                    PlaneConfig{.name = "paper", .point = {0, 0, -1}, .normal = {0, 0, 1}}};
  const std::vector<FigureFile> figures = report_figures(data);
  EXPECT_NE(svg_of(figures, "arm-end.svg").find("<title>slope"), std::string::npos);
  EXPECT_EQ(svg_of(figures, "arm-end.svg").find("<title>paper"), std::string::npos);
}

TEST(ReportFigures, AreWellFormedAndHaveNoMissingNumbers) {
  for (const ReportData& data : {paper_run(100), paper_run(0), spatial_run()}) {
    for (const FigureFile& figure : report_figures(data)) {
      SCOPED_TRACE(figure.file_name);
      EXPECT_EQ(xml_fault(figure.svg), "");
      EXPECT_TRUE(figure.svg.starts_with("<svg xmlns="));
      EXPECT_EQ(figure.svg.find("nan"), std::string::npos);
      EXPECT_EQ(figure.svg.find("inf"), std::string::npos);
    }
  }
}

TEST(ReportFigures, OfThePapersArmShowItsEndEffector) {
  const std::vector<FigureFile> figures = report_figures(paper_run(100));
  EXPECT_EQ(names_of(figures),
            (std::set<std::string>{"arm-start.svg", "arm-middle.svg", "arm-end.svg", "tip-path.svg",
                                   "bends.svg", "archings.svg", "cord-angles.svg", "tip.svg"}));
  EXPECT_NE(svg_of(figures, "arm-start.svg").find(">E(0.000, 16.000)<"), std::string::npos);
  EXPECT_NE(svg_of(figures, "arm-middle.svg").find(">E(-7.925, 12.649)<"), std::string::npos);
  EXPECT_NE(svg_of(figures, "arm-end.svg").find(">E(-10.738, 5.201)<"), std::string::npos);
}

TEST(ReportFigures, OfASpatialArmShowBothViewsAndStretches) {
  const std::vector<FigureFile> figures = report_figures(spatial_run());
  EXPECT_EQ(names_of(figures),
            (std::set<std::string>{"arm-start.svg", "arm-middle.svg", "arm-end.svg", "tip-path.svg",
                                   "bends-x.svg", "bends-y.svg", "stretches.svg", "tip.svg"}));
  for (const char* name : {"arm-end.svg", "tip-path.svg"}) {
    EXPECT_NE(svg_of(figures, name).find(">X (m)<"), std::string::npos);
    EXPECT_NE(svg_of(figures, name).find(">Z (m)<"), std::string::npos);
  }
}

// Returns the numbers of every element with this attribute.
std::vector<double> numbers_of(const std::string& svg, const std::string& attribute) {
  std::vector<double> numbers;
  const std::string key = " " + attribute + "=\"";
  for (std::size_t at = svg.find(key); at != std::string::npos; at = svg.find(key, at + 1)) {
    numbers.push_back(std::stod(svg.substr(at + key.size())));
  }
  return numbers;
}

TEST(ReportFigures, KeepEveryLabelAndDotOnThePage) {
  for (const ReportData& data : {paper_run(100), paper_run(0), spatial_run()}) {
    for (const FigureFile& figure : report_figures(data)) {
      SCOPED_TRACE(figure.file_name);
      const double width = numbers_of(figure.svg, "width").front();
      const double height = numbers_of(figure.svg, "height").front();
      for (const char* attribute : {"x", "cx"}) {
        for (const double x : numbers_of(figure.svg, attribute)) EXPECT_TRUE(x >= 0.0 && x <= width) << x;
      }
      for (const char* attribute : {"y", "cy"}) {
        for (const double y : numbers_of(figure.svg, attribute)) EXPECT_TRUE(y >= 0.0 && y <= height) << y;
      }
    }
  }
}

TEST(ReportHtml, ShowsTextsAndRunsNoneOfThem) {
  ReportData data = paper_run(10);
  const std::string hostile =
      "]]></pre></script><script>alert(1)</script><img src=x onerror=alert(2)>{{data}}";
  data.title = data.version = data.experiment_text = hostile;
  data.events.push_back({1.0, hostile, hostile});
  const std::string html = report_html(data);
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  const std::string escaped =
      "]]&gt;&lt;/pre&gt;&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&lt;img src=x "
      "onerror=alert(2)&gt;{{data}}";
  EXPECT_EQ(times_in(html, escaped), 6u) << "title twice, version, experiment, and an event's kind and text";
}

TEST(ReportHtml, GivesTheViewIn3DWhatStandsAroundTheArm) {
  ReportData data = paper_run(10);
  const std::string hostile = "</script><b>\"\\\n";
  data.obstacles = {BoxConfig{.name = hostile, .center = {1, 2, 3}, .half_sizes = {1, 1, 0.5}}};
  data.space.cameras = {{hostile, {{0, Pose(), {-0.5, 0.5, -0.4, 0.4}}}}};
  ReportSpace::Target target{.name = hostile, .start = 0, .end = 5};
  target.shape = Backbone(data.arm, data.states.back());
  target.position = Eigen::Vector3d(-10, 5, 0);
  data.space.targets = {target};
  data.space.true_arms = {{0, points_along(Backbone(data.arm, data.states.front()), 3)}};
  const std::string html = report_html(data);
  const std::string name = R"("name":"\u003c/script\u003e\u003cb\u003e\u0022\u005c\u000a")";
  EXPECT_EQ(times_in(html, name), 3U) << "an obstacle, a camera and a target, none of which ends the script";
  for (const char* part : {R"("kind":"box","center":[1,2,3],"axes":[[1,0,0],[0,1,0],[0,0,0.5]])",
                           R"("views":[[0,0,0,0,1,0,0,0,1,0,0,0,1,-0.5,0.5,-0.4,0.4]])",
                           R"("start":0,"end":5,"line":[0,0,0,)", R"("position":[-10,5,0])",
                           // The straight arm of 16 m, in shares of its length.
                           R"("truth":[{"time":0,"line":[0,0,0,0,25000,0,0,50000,0]}])"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(report_html(data), html) << "the same run gives the same bytes";
}

TEST(ReportHtml, LoadsNothing) {
  const std::string html = report_html(spatial_run());
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(html.find("unsafe-inline"), std::string::npos);
  for (const char* text : {" src=", "url(", "@import", "href=\"http", "style=\""}) {
    EXPECT_EQ(html.find(text), std::string::npos) << text;
  }
}

TEST(ReportHtml, StaysSmallForLongRunsAndSaysSo) {
  ReportData data = paper_run(100'000);
  data.events.resize(5000, {2.5, "event", "again"});
  const std::string html = report_html(data);
  EXPECT_LT(html.size(), 2'000'000u);
  for (const char* part : {"<dd>E(-10.738, 5.201)</dd>", "<dd>16.000 m</dd>", "<dd>5.000 s</dd>"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_NE(html.find("of the 100001 recorded states"), std::string::npos);
  EXPECT_NE(html.find("the first 1000 of 5000 events"), std::string::npos);
}

TEST(ReportHtml, ShowsARunOfOneState) {
  const std::string html = report_html(paper_run(0));
  EXPECT_NE(html.find("<dd>0.000 s</dd>"), std::string::npos);
  EXPECT_NE(html.find("<dd>E(0.000, 16.000)</dd>"), std::string::npos);
  EXPECT_NE(svg_of(report_figures(paper_run(0)), "tip-path.svg").find("start, middle, end"),
            std::string::npos)
      << "one name at the one point of the tip's path";
}

}  // namespace
}  // namespace flexura
