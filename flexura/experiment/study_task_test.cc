// Studies in experiment files and in results.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "flexura/experiment/schedule.h"
#include "flexura/store/csv_reader.h"
#include "flexura/study/image_study.h"
#include "tests/support/checkout.h"
#include "tests/support/experiment_files.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::filesystem::path example = checkout_file("examples/04_image_study/experiment.toml");

constexpr const char* good_study = R"([[arm.section]]
length = 1.0
[[camera]]
name = "front"
mount = { position = [0, 0, 2.5], look_at = [0, 0, 0] }
[[camera]]
name = "side"
mount = { position = [-2.5, 0, 0], look_at = [0, 0, 0] }
[[task]]
kind = "study"
camera = "front"
vary.orbit_deg = [-60, 60]
points = 5
target.radius = 0.4
)";

std::string study_with(const std::string& from, const std::string& to) {
  return replaced(good_study, from, to);
}

// Returns the result of the first task, a study.
ImageStudy images_of(const Experiment& experiment) {
  return study_images(std::get<StudyTask>(experiment.task.front()), experiment.cameras(),
                      static_cast<std::uint64_t>(experiment.seed));
}

class Study : public ::testing::Test, public Runs {
 protected:
  // Returns the number of values at which the first study has all features.
  static std::int64_t seen(const RunResult& result) {
    return *entry_of(result, "studies").find("seen")->as<std::int64_t>();
  }
};

TEST_F(Study, BadFilesSayWhatIsWrong) {
  const std::vector<BadFile> files{
      {"good", good_study, "no error"},
      {"no such camera", study_with("camera = \"front\"", "camera = \"back\""),
       "x.toml:11:1: task[0].camera: there is no camera \"back\": expected one of \"front\", \"side\""},
      {"nothing varied", study_with("vary.orbit_deg = [-60, 60]", "vary = {}"),
       "x.toml:12:1: task[0].vary: has no parameter: expected one parameter, such as orbit_deg = [-60, 60]"},
      {"no vary", study_with("vary.orbit_deg = [-60, 60]", ""), "task[0].vary: missing: expected a table"},
      {"two varied", study_with("points = 5", "vary.zoom = [1, 2]"),
       "x.toml:13:6: task[0].vary.zoom: is given together with vary.orbit: expected one parameter"},
      {"unknown parameter", study_with("orbit_deg", "orbits_deg"),
       "vary.orbits_deg: unknown key; did you mean \"orbit"},
      {"wrong unit", study_with("orbit_deg", "orbit_mm"), "vary.orbit_mm: wrong unit: expected orbit (rad)"},
      {"one value", study_with("[-60, 60]", "[60]"), "expected an array of 2"},
      {"the same value", study_with("[-60, 60]", "[60, 60]"), "has two equal values"},
      {"NaN", study_with("-60", "nan"), "task[0].vary.orbit_deg[0] = nan: expected a number from"},
      {"infinity", study_with("-60", "inf"), "task[0].vary.orbit_deg[0] = inf: expected a number from"},
      {"many turns", study_with("-60", "-60000"),
       "task[0].vary.orbit_deg[0] = -60000: expected a number from"},
      {"beyond the head", study_with("orbit_deg = [-60", "tilt_deg = [-46"),
       "task[0].vary.tilt[0]: -0.802851 is outside the axis's limits -0.785398 to 1.5708"},
      {"beyond the zoom", study_with("orbit_deg = [-60, 60]", "zoom = [1, 11]"),
       "task[0].vary.zoom[1]: 11 is outside the axis's limits 1 to 10"},
      {"a stage without travel", study_with("orbit_deg = [-60, 60]", "stage_z_mm = [0, 10]"),
       "task[0].vary.stage_z[1]: 0.01 is outside the axis's limits 0 to 0"},
      {"no focal length", study_with("orbit_deg = [-60, 60]", "focal_length = [0, 800]"),
       "task[0].vary.focal_length[0] = 0: expected a number from 0.001"},
      {"no points", study_with("points = 5", "points = 0"),
       "task[0].points = 0: expected a whole number from 2 to 10000"},
      {"half a point", study_with("points = 5", "points = 4.5"),
       "task[0].points = 4.5: expected a whole number"},
      {"no radius", study_with("radius = 0.4", "radius = 0"),
       "task[0].target.radius = 0: expected a number from 1e-06 m"},
      {"no normal", study_with("target.radius = 0.4", "target.normal = [0, 0, 0]"),
       "task[0].target.normal: has no direction: expected a length above 0"},
      {"in the camera", study_with("target.radius = 0.4", "target.center = [0, 0, 2.5]"),
       "task[0].target.center: is the camera's position: the camera cannot orbit this point"},
  };
  for (const BadFile& file : files) EXPECT_THAT(error_of_file(file.text), HasSubstr(file.error)) << file.what;
}

TEST_F(Study, TakesTheDefaultCamerasToo) {
  std::string text = replaced(good_study, "camera = \"front\"\n", "");
  text.erase(text.find("[[camera]]"), text.find("[[task]]") - text.find("[[camera]]"));
  const Experiment experiment = parse_experiment(text, "x.toml");
  EXPECT_EQ(images_of(experiment).camera, "front");
  EXPECT_EQ(error_of_file(replaced(text, "points", "camera = \"side\"\npoints")), "no error");
}

TEST_F(Study, TakesNoTimeAndLeavesTheArmAlone) {
  const std::string more = std::string(good_study) + "[[task]]\nkind = \"hold\"\nduration = 1\n";
  const Schedule schedule(parse_experiment(more, "x.toml"));
  EXPECT_EQ(schedule.legs().at(0).kind, "study");
  EXPECT_EQ(schedule.legs()[0].end(), 0);
  EXPECT_EQ(schedule.duration(), 1);
}

TEST_F(Study, WritesTableFiguresReportAndSummary) {
  const RunResult result = run(parse_experiment(good_study, "x.toml"));
  EXPECT_EQ(result.outcome, RunOutcome::done);
  const NumberTable table = parse_csv(text_of(result, "tables/study.csv"), "study.csv");
  ASSERT_EQ(table.columns.size(), 20U);
  EXPECT_EQ(table.columns[0], "orbit");
  EXPECT_EQ(table.columns[1], "top_formula");
  EXPECT_EQ(table.columns[10], "top_rendered");
  EXPECT_EQ(table.columns[19], "in_image");
  EXPECT_EQ(table.rows.size(), 5U);
  for (const char* figure : {"image", "edges", "sizes", "distances", "axes"}) {
    const std::string svg = text_of(result, fmt::format("figures/study-{}.svg", figure));
    EXPECT_THAT(svg, ::testing::Not(HasSubstr("nan"))) << figure;
    EXPECT_THAT(svg, HasSubstr("orbit"));
  }
  const std::string html = text_of(result, "report.html");
  EXPECT_THAT(html, HasSubstr("Study: study"));
  EXPECT_THAT(html, HasSubstr("id=\"picture-study-image\""));
  const Node& study = entry_of(result, "studies");
  EXPECT_EQ(*study.find("seen")->as<std::int64_t>(), 5);
  EXPECT_LE(*study.find("largest_difference_px")->as<double>(), 1e-9);
}

TEST_F(Study, NamesItsFilesSafelyAndEachOnce) {
  Experiment experiment = parse_experiment(good_study, "x.toml");
  const auto study = std::get<StudyTask>(experiment.task[0]);
  experiment.task.clear();
  for (const char* name : {"", "study", "../a b", "..", "été", "A.1"}) {
    experiment.task.emplace_back(study);
    std::get<StudyTask>(experiment.task.back()).name = name;
  }
  std::vector<std::string> names;
  const RunResult result = run(experiment);
  for (const Node& one : *result.summary.find("studies")->as<Node::Array>())
    names.push_back(*one.find("name")->as<std::string>());
  EXPECT_THAT(names, ElementsAre("study", "study-2", "-.-a-b", "-.", "--t--", "A.1"));
  EXPECT_TRUE(std::filesystem::exists(result.folder / "tables" / "study-2.csv"));
}

TEST_F(Study, LeavesCellsEmptyForATargetBehindTheCamera) {
  const std::string behind = study_with("target.radius = 0.4", "target.center = [0, 0, 4]");
  EXPECT_EQ(seen(run(parse_experiment(behind, "x.toml"))), 5) << "in orbit the camera turns to it";
  const RunResult unseen =
      run(parse_experiment(replaced(behind, "orbit_deg = [-60, 60]", "zoom = [1, 2]"), "x.toml"));
  EXPECT_EQ(seen(unseen), 0);
  EXPECT_THAT(text_of(unseen, "tables/study.csv"), HasSubstr("\n1.25,,,,,,,,,,,,,,,,,,,0\n"));
  EXPECT_THAT(text_of(unseen, "figures/study-edges.svg"), HasSubstr("edges of the square"));
}

TEST_F(Study, MeasuresInTheNoiseOfTheExperimentsSeed) {
  const std::string noisy = replaced(study_with("points = 5", "points = 2\nmeasure = true"),
                                     "name = \"front\"", "name = \"front\"\nsensor = { read_noise = 2 }");
  const auto measured = [](const std::string& text) {
    return images_of(parse_experiment(text, "x.toml")).columns.at(2).features;
  };
  const auto first = measured("seed = 1\n" + noisy);
  EXPECT_EQ(measured("seed = 1\n" + noisy), first);
  EXPECT_NE(measured("seed = 2\n" + noisy), first);
}

TEST_F(Study, VariesDownwardsAsWell) {
  const RunResult up = run(parse_experiment(good_study, "x.toml"));
  const RunResult down = run(parse_experiment(study_with("[-60, 60]", "[60, -60]"), "x.toml"));
  const auto first = parse_csv(text_of(up, "tables/study.csv"), "up.csv");
  const auto second = parse_csv(text_of(down, "tables/study.csv"), "down.csv");
  EXPECT_EQ(first.rows.front(), second.rows.back());
  EXPECT_EQ(text_of(up, "figures/study-edges.svg"), text_of(down, "figures/study-edges.svg"));
}

TEST_F(Study, TheExampleGivesTheFiguresOfThePaper) {
  // Its rendered pictures, which do not affect the formulas, take half a minute: the documents' test has
  // them.
  const Overrides formulas_alone = {.sets = {"task.1.measure=false", "task.3.measure=false"}, .seed = {}};
  const RunResult result = run(load_experiment(example, formulas_alone));
  EXPECT_EQ(result.outcome, RunOutcome::done);
  const auto row_at = [&](const std::string& study, double value) {
    const NumberTable table = parse_csv(text_of(result, "tables/" + study + ".csv"), study);
    for (const auto& row : table.rows)
      if (std::abs(row[0] - value) < 1e-9) return row;
    ADD_FAILURE() << study << " has no row at " << value;
    return std::vector<double>(20);
  };
  constexpr double twenty_degrees = 0.3490658503988659;
  for (const std::size_t source : {1U, 10U}) {
    const auto orbit = row_at("orbit", twenty_degrees);
    EXPECT_NEAR(orbit[source], 237.7751, 5e-5);
    EXPECT_NEAR(orbit[source + 1], 215.8345, 5e-5);
    EXPECT_NEAR(orbit[source + 4], 213.1268, 5e-5);
    EXPECT_NEAR(orbit[source + 6], 163.1414, 5e-5);
    EXPECT_NEAR(orbit[source + 7], 161.3906, 5e-5);
    const auto tilt = row_at("tilt", twenty_degrees);
    EXPECT_NEAR(tilt[source], 229.0082, 5e-5);
    EXPECT_NEAR(tilt[source + 1], 253.8631, 5e-5);
    EXPECT_NEAR(tilt[source + 4], 256.9304, 5e-5);
    EXPECT_NEAR(row_at("zoom", 3)[source], 3 * row_at("zoom", 1)[source], 1e-9);
    EXPECT_NEAR(row_at("zoom", 3)[source + 6], 3 * row_at("zoom", 1)[source + 6], 1e-9);
  }
  for (const Node& study : *result.summary.find("studies")->as<Node::Array>()) {
    EXPECT_LE(*study.find("largest_difference_px")->as<double>(), 1e-9);
    EXPECT_LE(*study.find("largest_difference_axes_ratio")->as<double>(), 1e-9);
  }
}

TEST_F(Study, WritesTheSameBytesEachTimeAndFromItsOwnFile) {
  const RunResult first = run(parse_experiment(std::string("title = \"t\"\n") + good_study, "x.toml"));
  const RunResult second = run(load_experiment(first.folder / experiment_file_name));
  for (const char* file : {"tables/study.csv", "figures/study-image.svg", "summary.json", "report.html"})
    EXPECT_EQ(text_of(first, file), text_of(second, file)) << file;
}

}  // namespace
}  // namespace flexura
