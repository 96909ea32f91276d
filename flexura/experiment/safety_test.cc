// Safety in files: obstacles, targets of the tip, limits of motors; and results of checks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/report_safety.h"
#include "flexura/experiment/safety_nodes.h"
#include "flexura/experiment/schedule.h"
#include "flexura/model/backbone.h"
#include "flexura/report/report.h"
#include "flexura/safety/violation.h"
#include "flexura/store/json.h"
#include "tests/support/experiment_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const std::string arm =
    "[arm]\nkind = 'spatial'\n[[arm.section]]\nlength = 1\n[[arm.section]]\nlength = 0.5\n";

Experiment parse(const std::string& rest) { return parse_experiment(arm + rest, "x.toml"); }

SafetyReport check(const std::string& rest) { return Schedule(parse(rest)).check(); }

std::string error_of_rest(const std::string& rest) { return error_of_file(arm + rest); }

TEST(Obstacles, BadOnesGetAClearLineWithTheirPlace) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"name = 'x'", "x.toml:7:1: obstacle[0]: kind is missing: expected one of"},
      {"kind = 'ball'", R"(x.toml:8:8: obstacle[0].kind = "ball": expected one of "plane", "sphere")"},
      {"kind = 'sphere'\nradius = 1", "x.toml:7:1: obstacle[0].center: missing: expected"},
      {"kind = 'sphere'\ncenter = [0, 0]\nradius = 1",
       "x.toml:9:10: obstacle[0].center is an array of 2: expected an array of 3"},
      {"kind = 'sphere'\ncenter = [0, 0, 0]\nradius = 0", "x.toml:10:10: obstacle[0].radius = 0: expected"},
      {"kind = 'sphere'\ncenter = [0, 0, nan]\nradius = 1",
       "x.toml:9:17: obstacle[0].center[2] = nan: expected"},
      {"kind = 'sphere'\ncenter = [0, 0, 0]\nradios = 1", "did you mean \"radius\"?"},
      {"kind = 'plane'\nnormal = [0, 0, 0]", "x.toml:9:1: obstacle[0].normal: has no direction: expected"},
      {"kind = 'plane'\nignore_base = -1", "x.toml:9:15: obstacle[0].ignore_base = -1: expected"},
      {"kind = 'capsule'\nfrom = [0, 0, 0]\nradius = 1", "x.toml:7:1: obstacle[0].to: missing: expected"},
      {"kind = 'box'\ncenter = [0, 0, 0]\nhalf_sizes = [1, 0, 1]",
       "x.toml:10:18: obstacle[0].half_sizes[1] = 0"},
      {"kind = 'box'\ncenter = [0, 0, 0]\nhalf_sizes = [1, 1, 1]\nrotation = [2, 0, 0, 0]",
       "x.toml:11:1: obstacle[0].rotation: has the norm 2: expected a unit quaternion"},
  };
  for (const auto& [text, error] : cases)
    EXPECT_THAT(error_of_rest("[[obstacle]]\n" + text + "\n"), HasSubstr(error)) << text;
}

TEST(Obstacles, AreKeptInTheExperimentAsRunAndNamedByTheirPlace) {
  const Experiment experiment = parse(
      "[[obstacle]]\nkind = 'plane'\nignore_base_mm = 50\n[[obstacle]]\nkind = 'capsule'\nfrom = [1, 0, "
      "0]\nto = "
      "[1, 2, 0]\nradius_mm = 100\n[[obstacle]]\nkind = 'box'\nname = 'desk'\ncenter = [0, 3, 0]\nhalf_sizes "
      "= "
      "[0.5, 0.1, 0.5]\n");
  const std::string text = experiment_toml(experiment);
  EXPECT_EQ(experiment_toml(parse_experiment(text, "as-run.toml")), text);
  const std::vector<Obstacle> around = obstacles(experiment.obstacle);
  ASSERT_EQ(around.size(), 3U);
  EXPECT_EQ(around[0].name, "plane 1");
  EXPECT_EQ(around[0].ignore_base, 0.05);
  EXPECT_EQ(around[1].name, "capsule 2");
  EXPECT_EQ(around[2].name, "desk");
}

TEST(Ground, IsTouchedByAnArmThatBendsDownToIt) {
  const std::string ground = "[[obstacle]]\nkind = 'plane'\nname = 'ground'\nignore_base = 0.1\n";
  const auto bow = [&](const char* bends) {
    return check(ground + "[[task]]\nkind = 'move'\nto.bends_deg = " + bends + "\n");
  };
  EXPECT_TRUE(bow("[[90, 0], [30, 0]]").is_safe());
  const SafetyReport down = bow("[[150, 0], [0, 0]]");
  ASSERT_EQ(down.violations.size(), 1U);
  EXPECT_THAT(down.violations[0].text(), HasSubstr("section 2: contact with ground, "));
}

TEST(TipTargets, AreReachedFromWhereTheArmIs) {
  const Experiment experiment = parse(
      "[[task]]\nkind = 'move'\nto.bends = [[0.3, 0], [0, 0.4]]\n"
      "[[task]]\nkind = 'move'\nname = 'there'\nto.position = [0.6, 0.9, -0.3]\n");
  const Schedule schedule(experiment);
  EXPECT_TRUE(schedule.check().is_safe());
  const Backbone end(experiment.arm.arm(), schedule.state_at(schedule.duration()));
  EXPECT_LT((end.tip().position - Eigen::Vector3d(0.6, 0.9, -0.3)).norm(), 1e-8);
  const std::string text = experiment_toml(experiment);
  EXPECT_EQ(experiment_toml(parse_experiment(text, "as-run.toml")), text);
}

TEST(TipTargets, OutsideTheWorkspaceAreViolationsWithTheNearestDistance) {
  const auto up_to = [](const char* height) {
    return check("[[task]]\nkind = 'hold'\n[[task]]\nkind = 'move'\nname = 'up'\nto.position = [0, " +
                 std::string(height) + ", 0]\n");
  };
  EXPECT_TRUE(up_to("1.5").is_safe());
  EXPECT_TRUE(up_to("1.499999").is_safe());
  const SafetyReport beyond = up_to("1.50001");
  ASSERT_EQ(beyond.violations.size(), 1U);
  const Violation& missed = beyond.violations[0];
  EXPECT_EQ(missed.hazard, Hazard::workspace);
  EXPECT_EQ(missed.start, 1);
  EXPECT_EQ(missed.end, 2);
  EXPECT_EQ(missed.name, "up");
  EXPECT_NEAR(missed.value, 1e-5, 1e-8);
  EXPECT_EQ(up_to("2").violations[0].text(),
            "1 s to 2 s: up: target outside the workspace, 500 mm from the nearest pose");
}

TEST(TipTargets, BesideAShapeAreRefused) {
  EXPECT_THAT(
      error_of_rest("[[task]]\nkind = 'move'\nto.position = [0, 1, 0]\nto.bends = [[0, 0], [0, 0]]\n"),
      HasSubstr(
          "task[0].to.position: is given together with a shape: expected either a position or a shape"));
  EXPECT_THAT(error_of_rest("[[task]]\nkind = 'move'\nto.position = [0, 1]\n"), HasSubstr("x.toml:9:"));
}

TEST(Report, ShowsWhatIsMissedAndTheSectionThatAMotorBends) {
  const Experiment experiment = parse(
      "[drive]\nmotor = { max_position = 100 }\ntendon = [{ section = 1, angle = 0 }, { section = 1, "
      "angle_deg = 90 "
      "},\n{ section = 2, angle_deg = 45 }, { section = 2, angle_deg = 135 }]\n"
      "[[task]]\nkind = 'move'\nto.position = [2, 0, 0]\n");
  const Schedule schedule(experiment);
  ReportData data;
  data.arm = experiment.arm.arm();
  for (const double time : {0.0, 0.5, 1.0}) {
    data.times.push_back(time);
    data.states.push_back(schedule.state_at(time));
  }
  add_safety(schedule.check(), schedule, data);
  bool has_target = false;
  bool has_motor = false;
  for (const auto& violation : data.safety->violations) {
    if (violation.target) {
      has_target = true;
      EXPECT_EQ(*violation.target, Eigen::Vector3d(2, 0, 0));
      EXPECT_EQ(violation.pictured_at, 1.0) << "though the motors are at their worst then, too";
    }
    if (violation.text.find("axis 1.3") != std::string::npos) {
      has_motor = true;
      EXPECT_EQ(violation.sections, std::vector<std::size_t>{1});
    }
  }
  EXPECT_TRUE(has_target);
  EXPECT_TRUE(has_motor);
  EXPECT_THAT(write_json(safety_node(schedule.check())), HasSubstr("\"target\":[2"));
}

TEST(Report, PicturesWhatComesAgainAndAgainOnce) {
  // Four swings beyond the limit of section 1, the third of which is the widest, and one of section 2.
  Experiment experiment = parse(
      "[[task]]\nkind = 'keyframes'\ncolumns = ['time', 'bend_x_1', 'bend_y_1', 'bend_x_2', 'bend_y_2']\n"
      "rows = [[0, 0, 0, 0, 0], [1, 1.2, 0, 0, 0], [2, 0, 0, 0, 0], [3, 1.3, 0, 0, 0], [4, 0, 0, 0, 0], "
      "[5, 1.4, 0, 0, 0], [6, 0, 0, 0, 0], [7, 1.2, 0, 0, 0], [8, 0, 0, 1.1, 0], [9, 0, 0, 0, 0]]\n");
  for (Section& section : experiment.arm.section) section.max_bend = 1;
  const Schedule schedule(experiment);
  ReportData data;
  data.arm = experiment.arm.arm();
  data.times = {0, 9};
  data.states = {schedule.state_at(0), schedule.state_at(9)};
  const SafetyReport report = schedule.check();
  EXPECT_GE(report.violations.size(), 5U);
  add_safety(report, schedule, data);
  std::vector<double> pictured;
  for (const auto& violation : data.safety->violations)
    if (violation.pictured_at) pictured.push_back(*violation.pictured_at);
  ASSERT_EQ(pictured.size(), 2U);
  EXPECT_NEAR(pictured[0], 5, 1e-3);
  EXPECT_NEAR(pictured[1], 8, 1e-3);
}

TEST(MotorLimits, OfAFileAreChecked) {
  const std::string drive =
      "[drive]\nmotor = { max_speed = 20 }\ntendon = [{ section = 1, angle = 0 }, { section = 1, angle_deg = "
      "90 },\n"
      "{ section = 2, angle_deg = 45 }, { section = 2, angle_deg = 135, motor = { max_position = 100 } }]\n";
  const std::string bend = "[[task]]\nkind = 'move'\nduration = 2\nto.bends = [[1, 0], [1, 0]]\n";
  const SafetyReport report = check(drive + bend);
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_EQ(report.violations[0].hazard, Hazard::motor_position);
  EXPECT_EQ(report.violations[0].name, "1.4");
  EXPECT_EQ(report.violations[0].section, 1U) << "where its tendon ends";
  EXPECT_THAT(error_of_rest("[drive]\nmotor = { max_position = 0 }\ntendon = []\n"),
              HasSubstr("max_position = 0"));
}

TEST(SafetyNodes, HoldWhatTheReportSays) {
  const SafetyReport report = check(
      "[[obstacle]]\nkind = 'sphere'\ncenter = [0, 1, 0]\nradius = 0.1\n[[task]]\nkind = 'expression'\n"
      "bends = [['0', '0']]\n");
  const Node node = parse_json(write_json(safety_node(report), 2), "node");
  EXPECT_FALSE(*node.find("safe")->as<bool>());
  const Node& violation = node.find("violations")->as<Node::Array>()->at(0);
  EXPECT_EQ(*violation.find("hazard")->as<std::string>(), "obstacle");
  EXPECT_EQ(*violation.find("obstacle")->as<std::string>(), "sphere 1");
  EXPECT_EQ(violation.find("axis"), nullptr);
  EXPECT_NEAR(*violation.find("value")->as<double>(), 0.12, 1e-6);
  EXPECT_EQ(*violation.find("text")->as<std::string>(), report.violations[0].text());
  EXPECT_THAT(*node.find("caveats")->as<Node::Array>()->at(0).as<std::string>(),
              HasSubstr("sampled every 0.02 s"));
}

TEST(SafetyNodes, StaySmallWhenAMotionRepeatsItself) {
  SafetyReport report;
  for (int k = 0; k < 2000; ++k) {
    report.violations.push_back({.hazard = Hazard::bend,
                                 .start = k + 0.1,
                                 .end = k + 0.4,
                                 .worst_time = k + 0.25,
                                 .section = 1,
                                 .value = k == 1900 ? 3.0 : 2.0,
                                 .limit = 1});
  }
  const Node node = safety_node(report);
  EXPECT_EQ(*node.find("violation_count")->as<std::int64_t>(), 2000);
  const auto& groups = *node.find("groups")->as<Node::Array>();
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(*groups[0].find("count")->as<std::int64_t>(), 2000);
  EXPECT_EQ(*groups[0].find("section")->as<std::int64_t>(), 2);
  EXPECT_EQ(*groups[0].find("start")->as<double>(), 0.1);
  EXPECT_EQ(*groups[0].find("end")->as<double>(), 1999.4);
  EXPECT_EQ(*groups[0].find("worst_time")->as<double>(), 1900.25);
  const auto& listed = *node.find("violations")->as<Node::Array>();
  ASSERT_EQ(listed.size(), max_listed_violations);
  EXPECT_EQ(*listed.back().find("value")->as<double>(), 3);
}

}  // namespace
}  // namespace flexura
