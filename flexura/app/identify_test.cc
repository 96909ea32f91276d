#include "flexura/app/identify.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/store/json.h"
#include "tests/support/checkout.h"
#include "tests/support/random_cases.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const std::string step_response = checkout_file("examples/15_step_response/experiment.toml");

std::vector<Node> json_lines(const std::string& text) {
  std::vector<Node> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(parse_json(line, "answer"));
  return lines;
}
double number_in(const Node& line, const char* key) { return *line.find(key)->as<double>(); }

class Identify : public Runs, public testing::Test {
 protected:
  struct Printed {
    int status = 0;
    std::string out, err;
  };
  static Printed printed(const IdentifyArguments& arguments) {
    std::ostringstream out, err;
    const int status = identify_command(arguments, out, err);
    return {status, out.str(), err.str()};
  }
  static std::string refused(const IdentifyArguments& arguments) {
    try {
      return printed(arguments).out;
    } catch (const InputError& error) {
      return error.what();
    }
  }
  // Returns the results of one oscillation of the example, which is run once.
  static std::string results() {
    static TemporaryFolder folder;
    static std::optional<std::string> made;
    if (!made) {
      const std::vector<std::string> sets = {"record.report=false", "record.scene=false",
                                             "task.4.duration=0.1"};
      Quiet quiet;
      made = run_experiment(load_experiment(step_response, {sets, {}}),
                            make_new_folder(folder.path() / "run"), quiet)
                 .folder.string();
    }
    return *made;
  }
  std::string written(const std::string& name, const std::string& text) {
    const auto file = folder_.path() / name;
    std::ofstream(file) << text;
    return file.string();
  }
};

void expect_the_truth(const std::vector<Node>& lines) {
  struct Known {
    const char* parameter;
    int section;
    double value, nominal;
  };
  const std::vector<Known> known = {{"youngs_modulus", 1, 3.0e5, 2.5e5},
                                    {"damping_time", 1, 0.024, 0.02},
                                    {"youngs_modulus", 2, 2.1e5, 2.5e5},
                                    {"damping_time", 2, 0.016, 0.02}};
  ASSERT_EQ(lines.size(), 5U);
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_EQ(*lines[i].find("parameter")->as<std::string>(), known[i].parameter);
    EXPECT_EQ(*lines[i].find("section")->as<std::int64_t>(), known[i].section);
    EXPECT_TRUE(*lines[i].find("observable")->as<bool>());
    EXPECT_EQ(number_in(lines[i], "nominal"), known[i].nominal);
    const double sigma = number_in(lines[i], "sigma");
    EXPECT_NEAR(number_in(lines[i], "value"), known[i].value, 3 * sigma) << i;
    // The nominal value is farther from the true one than the estimate's error.
    EXPECT_LT(3 * sigma, std::abs(known[i].value - known[i].nominal)) << i;
  }
  EXPECT_LT(number_in(lines[4], "residual_rms"), 0.2 * number_in(lines[4], "nominal_residual_rms"));
  EXPECT_LT(number_in(lines[4], "misfit"), 3);
}

TEST_F(Identify, FindsTheTrueMaterialByTheLogOfARun) {
  const Printed json =
      printed({.experiment = step_response, .motion = results(), .noise_mm = 0.2, .json = true});
  EXPECT_EQ(json.status, exit_done);
  expect_the_truth(json_lines(json.out));
  // The log file gives the same answer as the results folder; the table output agrees, too.
  EXPECT_EQ(
      printed({.experiment = step_response, .motion = results() + "/log.mcap", .noise_mm = 0.2, .json = true})
          .out,
      json.out);
  const Printed table = printed({.experiment = step_response, .motion = results(), .noise_mm = 0.2});
  EXPECT_THAT(table.out, HasSubstr("section 2: Young's modulus, Pa"));
  EXPECT_THAT(table.out, HasSubstr("in the file"));
}

// Laboratories provide tables of places. This one has every second place of the log, with unknown noise.
TEST_F(Identify, FindsItByATableOfPlaces) {
  const Experiment experiment = load_experiment(step_response);
  const Rod rod = rod_of(experiment.arm, experiment.drive);
  const MeasuredMotion motion = read_motion(results(), experiment, rod, {});
  const Pose X_WB = experiment.arm.arm().X_WB;
  std::string text = "time";
  for (std::size_t i = 1; i <= rod.tendons.size(); ++i) text += fmt::format(",tension_{}", i);
  const auto s_of = [&](const RodPlace& place) {
    return 0.25 * (static_cast<double>(place.section) + place.at);
  };
  for (std::size_t i = 1; i < motion.places.size(); i += 2)
    text += fmt::format(",x@{0},y@{0},z@{0}", s_of(motion.places[i]));
  TestRandom random(case_seed(0));
  for (const RodPlaceSample& sample : motion.samples) {
    text += fmt::format("\n{}", sample.time);
    for (const double tension : sample.tensions) text += fmt::format(",{}", tension);
    for (std::size_t i = 1; i < motion.places.size(); i += 2)
      for (const double coordinate : X_WB* sample.positions[i])
        text += fmt::format(",{}", coordinate + 1e-4 * normal_number(random));
  }
  const std::string file = written("places.csv", text + "\n");
  const Printed found = printed({.experiment = step_response, .motion = file, .json = true});
  EXPECT_EQ(found.status, exit_done);
  const std::vector<Node> lines = json_lines(found.out);
  expect_the_truth(lines);
  EXPECT_NEAR(number_in(lines[4], "noise"), 1e-4, 2e-5);
  EXPECT_EQ(*lines[4].find("places")->as<std::int64_t>(), 12);
}

TEST_F(Identify, SaysWhatAMotionDoesNotTell) {
  // The arm does not move before the step.
  const Printed found = printed({.experiment = step_response,
                                 .motion = results(),
                                 .to = 0.19,
                                 .noise_mm = 0.2,
                                 .window = 0.15,
                                 .json = true});
  for (const Node& line : json_lines(found.out))
    if (line.find("observable") != nullptr &&
        std::string(*line.find("parameter")->as<std::string>()) == "damping_time") {
      EXPECT_FALSE(*line.find("observable")->as<bool>());
      EXPECT_TRUE(line.find("value")->empty());
    }
}

// A motion run backwards gains energy, which no damping explains.
TEST_F(Identify, MarksValuesThatNoMaterialHas) {
  const Experiment experiment = load_experiment(step_response);
  const Rod rod = rod_of(experiment.arm, experiment.drive);
  MeasuredMotion motion = read_motion(results(), experiment, rod, {});
  std::ranges::reverse(motion.samples);
  const double end = motion.samples.front().time;
  for (RodPlaceSample& sample : motion.samples) sample.time = end - sample.time;
  NoProgress nobody;
  const IdentifiedArm found = identify_arm(experiment.arm, rod, motion, {.noise = 2e-4}, nobody);
  bool is_any = false;
  for (const IdentifiedValue& value : found.values) {
    if (!value.is_determined) continue;
    EXPECT_EQ(value.is_physical, value.value >= 0) << value.name;
    is_any = is_any || !value.is_physical;
  }
  EXPECT_TRUE(is_any);
  EXPECT_NEAR(found.step, 0.01, 1e-9);
}

TEST_F(Identify, RefusesWhatIsNoMotionOfTheArm) {
  const auto refuses = [&](const std::string& motion, const std::string& what) {
    EXPECT_THAT(refused({.experiment = step_response, .motion = motion}), HasSubstr(what));
  };
  refuses("nowhere",
          "nowhere: no such file: expected a folder made by `flexura run`, a log (.mcap), or measured");
  refuses(folder_.path().string(), "has no log.mcap");
  refuses(written("text.mcap", "no log at all, but text that is long enough"), "text.mcap");
  const std::string log = read_text_file(results() + "/log.mcap", 1 << 28);
  refuses(written("cut.mcap", log.substr(0, 300)), "has no messages");
  EXPECT_THAT(refused({.experiment = step_response, .motion = results(), .from = 50}),
              HasSubstr("has no true arm states (/arm/truth)"));
  EXPECT_THAT(refused({.experiment = step_response, .motion = results(), .to = 0.05}),
              HasSubstr("samples: expected at least"));
  EXPECT_EQ(refused({.experiment = step_response, .motion = results(), .from = 2, .to = 1}),
            "--from: 2 s is not before --to, 1 s: expected an earlier time");
  EXPECT_THAT(refused({.experiment = step_response, .motion = results(), .to = std::nan("")}),
              HasSubstr("--to: nan: expected a time"));
  // The log is of another arm.
  EXPECT_THAT(
      refused({.experiment = checkout_file("examples/13_grasp/experiment.toml"), .motion = results()}),
      HasSubstr("has a true arm of 48 arcs at 0 s: expected 24"));
  EXPECT_THAT(
      refused({.experiment = step_response, .motion = results(), .sets = {"arm.base.position=[0, 0, 0]"}}),
      HasSubstr("has an arm whose base is 0.8 m from the base of the experiment's arm"));
  EXPECT_THAT(
      refused({.experiment = step_response, .motion = results(), .sets = {"arm.section.0.length=0.3"}}),
      HasSubstr("no shape of the rod is near the measured places"));
  EXPECT_THAT(
      refused({.experiment = checkout_file("examples/01_paper_arm/experiment.toml"), .motion = results()}),
      HasSubstr("arm.section[0]: has no material"));
  EXPECT_THAT(refused({.experiment = step_response, .motion = results(), .noise_mm = -1}),
              HasSubstr("--noise-mm: -1: expected a number above 0"));
  EXPECT_THAT(refused({.experiment = step_response, .motion = results(), .window = std::nan("")}),
              HasSubstr("--window: nan: expected a number above 0"));
}

TEST_F(Identify, RefusesATableThatIsNone) {
  const std::string tensions = "time,tension_1,tension_2,tension_3,tension_4,tension_5,tension_6";
  const auto refuses = [&](const std::string& text, const std::string& what) {
    EXPECT_THAT(refused({.experiment = step_response, .motion = written("places.csv", text)}),
                HasSubstr(what));
  };
  refuses("", "places.csv");
  refuses("time,x\n0,1\n", "places.csv:1:1: 2 columns: expected time, tension_1 to tension_6, and x@S");
  refuses("t" + tensions.substr(4) + ",x@0.1,y@0.1,z@0.1\n", "10 columns: expected time");
  refuses("time,a" + tensions.substr(14) + ",x@0.1,y@0.1,z@0.1\n",
          "column 2 is \"a\": expected \"tension_1\"");
  refuses(tensions + ",x@0.1,y@0.1,z@0.2\n", "columns 8 to 10 are not a position");
  refuses(tensions + ",x@0.9,y@0.9,z@0.9\n", "\"x@0.9\" is not on the arm");
  refuses(tensions + ",x@0.1,y@0.1,z@0.1\n0,1,1,1,1,1,1,nan,0,0\n", "places.csv:2:15:");
  refuses(tensions + ",x@0.1,y@0.1,z@0.1\n0,1,1,-1,1,1,1,0,0,0\n", "places.csv:2:1: tension_3 = -1");
  refuses(tensions + ",x@0.1,y@0.1,z@0.1\n0,1,1,1,1,1,1,0,0,0\n0,1,1,1,1,1,1,0,0,0\n",
          "places.csv:3:1: time 0: expected a time after 0");
  refuses(tensions + ",x@0.1,y@0.1,z@0.1\n0,1,1,1,1,1,1,0,0,0\n1,1,1,1,1,1,1,0,0,0\n",
          "1 places do not determine 16 strain modes");
}

}  // namespace
}  // namespace flexura
