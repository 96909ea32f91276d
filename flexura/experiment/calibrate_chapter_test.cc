// Tests a calibration in the report: decreasing offsets, and both cameras before and after.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/tasks/calibrate/calibrate_run.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/loop_files.h"

namespace flexura {
namespace {

template <class Content>
const Content& content_of(const Chapter& chapter, const std::string& name) {
  const auto found = std::ranges::find(chapter.figures, name, &ReportFigure::name);
  if (found == chapter.figures.end()) throw std::runtime_error("no figure " + name);
  return std::get<Content>(found->content);
}

// Returns the part of a drawing's text between `from` and the next `to`.
std::string part(const Drawing& drawing, const std::string& from, const std::string& to) {
  const std::size_t begin = drawing.body.find(from) + from.size();
  return drawing.body.substr(begin, drawing.body.find(to, begin) - begin);
}

// Returns the corners of the first line of this class, px of the page.
std::vector<Eigen::Vector2d> line_of(const Drawing& drawing, const std::string& css_class) {
  std::size_t at = drawing.body.find("class=\"line " + css_class);
  if (at == std::string::npos) return {};
  at = drawing.body.find(" d=\"", at) + 4;
  const std::string path = drawing.body.substr(at, drawing.body.find('"', at) - at);
  std::vector<Eigen::Vector2d> points;
  std::string numbers = path;
  std::ranges::replace_if(numbers, [](char c) { return c == 'M' || c == 'L' || c == ','; }, ' ');
  std::istringstream words(numbers);
  for (Eigen::Vector2d point; words >> point.x() >> point.y();) points.push_back(point);
  return points;
}

double middle_column(const std::vector<Eigen::Vector2d>& line) {
  const auto [least, most] =
      std::ranges::minmax(line, {}, [](const Eigen::Vector2d& point) { return point.x(); });
  return 0.5 * (least.x() + most.x());
}

TEST(CalibrationChapter, ShowsOffsetsFallingAndBothCamerasBeforeAndAfter) {
  LoopRig rig;
  rig.size = 0.5;
  rig.wrong = {WrongStart{.pan = 0.08, .shift = {0.05, 0, 0}}, WrongStart{.pan = -0.07}};
  CalibrationBench bench(etalon_rig("method = \"etalon\"\n", rig));
  CalibrationRun run;
  run.name = "cylinder", run.is_before_etalon = true, run.cameras = {"front", "side"};
  run.nominal = bench.nominal();
  run.loop = bench.calibrate();
  ASSERT_TRUE(run.loop->is_done) << run.loop->reason;
  const Chapter chapter = calibration_chapter(run, 0);
  EXPECT_EQ(chapter.heading, "Calibration: cylinder");
  for (const std::string camera : {"front", "side"}) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, camera);
    const Drawing& before = content_of<Drawing>(chapter, "calibration-1-" + camera + "-before");
    const Drawing& after = content_of<Drawing>(chapter, "calibration-1-" + camera + "-after");
    EXPECT_NE(part(before, "href=\"", "\""), part(after, "href=\"", "\"")) << "the same picture";
    // Before, the silhouette is beside the cross in the middle; afterwards, around it.
    const double middle_before = middle_column(line_of(before, "s5")),
                 middle_after = middle_column(line_of(after, "s5"));
    EXPECT_GT(std::abs(middle_column(line_of(before, "s2")) - middle_before), 15);
    EXPECT_LT(std::abs(middle_column(line_of(after, "s2")) - middle_after), 2);
    // Powers of ten: from tens of pixels to the accepted offset, or the error that a head's step leaves.
    const auto& offsets = content_of<LineChart>(chapter, "calibration-1-offsets-" + camera);
    EXPECT_EQ(offsets.series.at(0).name, "horizontal orientation (px)");
    std::vector<double> seen = offsets.series[0].values;  // Not a number while another offset was measured.
    std::erase_if(seen, [](double value) { return std::isnan(value); });
    ASSERT_GE(seen.size(), 2U);
    EXPECT_LT(seen.back(), seen.front() - 1);
  }
}

}  // namespace
}  // namespace flexura
