#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/log/export_csv.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/messages.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/task_kinds.h"
#include "tests/support/runs.h"

// Runs whose true arm is an elastic rod.
namespace flexura {
namespace {

const std::string rod_text = R"([clock]
step = 0.1
[arm]
kind = "spatial"
[[arm.section]]
length = 0.5
radius = 0.015
[truth.arm]
model = "static"
gravity = [0, -9.81, 0]
[[truth.arm.section]]
material = { youngs_modulus = 200e9, radius_mm = 1.5, mass_per_length = 0.1 }
[[truth.arm.tendon]]
section = 1
radius_mm = 10
[[truth.arm.tendon]]
section = 1
radius_mm = 10
angle_deg = 120
[[truth.arm.tendon]]
section = 1
radius_mm = 10
angle_deg = 240
[[task]]
kind = "move"
duration = 1
to.bends = [[1.2, 0.4]]
)";

class StaticArm : public Runs, public testing::Test {};

// No task uses cameras and nothing is filmed: the effect of forces is still played.
TEST_F(StaticArm, IsPlayedAndLogsItsTensionsAndItsSag) {
  const RunResult result = run(rod_text);
  const auto pulls = logged<TensionsMessage>(result, arm_tensions_topic);
  const auto truth = logged<PosesMessage>(result, arm_truth_topic);
  const auto commanded = logged<PosesMessage>(result, arm_poses_topic);
  ASSERT_EQ(pulls.size(), truth.size());
  ASSERT_EQ(commanded.size(), 11U);
  EXPECT_NEAR(pulls.back().time, 1, 1e-9);
  ASSERT_EQ(pulls.back().tensions.size(), 3U);
  for (const TensionsMessage& at : pulls)
    for (const double tension : at.tensions) EXPECT_GE(tension, 0);
  EXPECT_GT(pulls.back().tensions[0], 1);
  EXPECT_LT(pulls.front().tensions[0], pulls.back().tensions[0]);
  // It differs from the command: its weight moves it lower, as far as its tendons allow, and that needs less
  // tension.
  const VectorMessage tip = truth.back().poses.back().position, sent = commanded.back().poses.back().position;
  EXPECT_GT(std::abs(tip.y - sent.y), 1e-4);
  const RunResult light = run(rod_text, {"truth.arm.gravity=[0,0,0]"});
  const VectorMessage up = logged<PosesMessage>(light, arm_truth_topic).back().poses.back().position;
  EXPECT_LT(tip.y, up.y - 5e-4);
  EXPECT_GT(tip.x, up.x + 5e-4);
  EXPECT_LT(pulls.back().tensions[0], logged<TensionsMessage>(light, arm_tensions_topic).back().tensions[0]);
}

// Requests the truth at every other step.
class SeesTheTruth : public RunWatcher {
 public:
  void state(double time, const ArmState&, std::span<const CameraReading>) override { time_ = time; }
  bool needs_truth() override { return needs_truth_ = !needs_truth_; }
  void truth(double time, const TrueArm& arm) override {
    EXPECT_EQ(time, time_);
    seen.push_back(arm);
  }
  std::vector<TrueArm> seen;

 private:
  double time_ = -1;
  bool needs_truth_ = false;
};

TEST_F(StaticArm, IsToldToAWatcherAsItTrulyLies) {
  SeesTheTruth watcher;
  const RunResult result = run(parse_experiment(rod_text, "x.toml"), &watcher);
  ASSERT_EQ(watcher.seen.size(), 6U) << "of 11 steps";
  const auto truth = logged<PosesMessage>(result, arm_truth_topic);
  const auto pulls = logged<TensionsMessage>(result, arm_tensions_topic);
  for (std::size_t i = 0; i < 6; ++i) {
    const VectorMessage tip = truth[2 * i].poses.back().position;
    const TrueArm& seen = watcher.seen[i];
    EXPECT_LT((seen.backbone.tip().position - Eigen::Vector3d(tip.x, tip.y, tip.z)).norm(), 1e-9);
    EXPECT_EQ(seen.tensions, pulls[2 * i].tensions);
    EXPECT_EQ(seen.pulled.size(), 3U);
    EXPECT_TRUE(seen.lost_steps.empty()) << "it has no motors";
  }
  EXPECT_NEAR(watcher.seen.back().pulled[0], 1.2 * 0.01, 1e-9);
  // A watcher must not influence the run.
  EXPECT_EQ(files_in(run(rod_text).folder), files_in(result.folder));
}

TEST_F(StaticArm, IsInTheReportAndInTheTables) {
  const RunResult result = run(rod_text);
  EXPECT_THAT(text_of(result, "report.html"), testing::HasSubstr("The true arm"));
  for (const char* figure : {"figures/true-arm.svg", "figures/tensions.svg", "figures/tip-off.svg"})
    EXPECT_TRUE(std::filesystem::exists(result.folder / figure)) << figure;
  const ExportResult exported = export_csv(result.folder, task_tables());
  const std::string table = read_text_file(exported.folder / "tensions.csv", 1 << 20);
  EXPECT_THAT(table, testing::StartsWith("time,tension_1,tension_2,tension_3\n"));
  EXPECT_EQ(std::ranges::count(table, '\n'), 12);
}

TEST_F(StaticArm, GivesTheSameLogEachTime) {
  const RunResult one = run(rod_text), other = run(rod_text);
  EXPECT_EQ(text_of(one, "log.mcap"), text_of(other, "log.mcap"));
}

// Its motors are too weak for the bend: events name the axes like the command list.
TEST_F(StaticArm, SaysWhichAxesLoseSteps) {
  std::string text = rod_text;
  text.erase(text.find("[[truth.arm.tendon]]"), text.find("[[task]]") - text.find("[[truth.arm.tendon]]"));
  text += R"([drive]
radius_mm = 10
axes_per_controller = 2
[truth.drive.motor]
pull_out = [[0, 0.05]]
)";
  for (const char* angle : {"0", "120", "240"})
    text += std::string("[[drive.tendon]]\nsection = 1\nangle_deg = ") + angle + "\n";
  const RunResult result = run(text);
  EXPECT_GT(logged<TensionsMessage>(result, arm_tensions_topic).back().lost_steps.value().front(), 0);
  EXPECT_THAT(text_of(result, "report.html"), testing::HasSubstr("the motor of axis 1.1 loses"));
}

// With a rod as the model and an empty [truth], the true arm must be the rod.
TEST_F(StaticArm, NeedsNoTruthOfItsOwn) {
  std::string text = rod_text;
  for (std::size_t at = text.find("truth."); at != std::string::npos; at = text.find("truth."))
    text.erase(at, 6);
  const std::string twice = "[arm]\nmodel = \"static\"\n";
  text.replace(text.find(twice), twice.size(), "");
  text.replace(text.find("[[arm.section]]\nmaterial"), 16, "");
  text.replace(text.find("gravity = [0, -9.81, 0]\n"), 24, "");
  text.replace(text.find("kind = \"spatial\"\n"), 17,
               "kind = \"spatial\"\nmodel = \"static\"\ngravity = [0, -9.81, 0]\n");
  EXPECT_EQ(logged<TensionsMessage>(run(text), arm_tensions_topic).back().tensions,
            logged<TensionsMessage>(run(rod_text), arm_tensions_topic).back().tensions);
}

}  // namespace
}  // namespace flexura
