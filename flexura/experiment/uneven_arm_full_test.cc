#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/log/export_csv.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/task_kinds.h"
#include "tests/support/checkout.h"
#include "tests/support/quiet.h"
#include "tests/support/servo_bench.h"
#include "tests/support/temporary_folder.h"

// The true arm does not fit any model with one arc per section.
namespace flexura {
namespace {

constexpr double uneven = 0.3;
const ArmState uneven_goal = {{{0.8, 0.3}, {-0.7, 0.9}, {1.0, -0.6}}, {1, 1, 1}};

// Returns a file with sections that truly bend more near their bases, and with their model.
std::string uneven_file(const std::string& task, const std::string& nominal) {
  ServoSetup rig;
  rig.arm += "\n" + nominal;
  for (int i = 0; i < 3; ++i)
    rig.rest += fmt::format("[[truth.arm.section]]\nbend_profile = [{}, 1, {}]\n", 1 + uneven, 1 - uneven);
  return servo_file(task + servo_target, rig);
}

struct Reached {
  ServoResult result;
  ServoError estimated;  // Error of the estimate, relative to the true arm at that time.
  ServoError left;       // Error of the arm, relative to the target.
};

Reached servo(const std::string& law, const std::string& nominal) {
  ServoBench bench(uneven_file("law = \"" + law + "\"\ntolerance = 0.02\n", nominal));
  Reached reached{bench.servo(), {}, {}};
  EXPECT_TRUE(reached.result.is_done) << reached.result.reason;
  if (!reached.result.last) return reached;
  const Arm shaped = bench.experiment().arm.model().shaped();
  const ServoObservation& observed = *reached.result.last;
  reached.estimated = servo_error(bench.rig().arm().backbone(observed.time),
                                  Backbone(shaped, observed.estimate.shape.state), shaped.length());
  reached.left = servo_error(bench.rig().arm().backbone(bench.rig().clock().now()),
                             bench.experiment().arm.model().backbone(uneven_goal), shaped.length());
  std::printf("%s, %s: the estimate %.4f %% of the length off, the arm %.4f %%\n", law.c_str(),
              nominal.empty() ? "one arc a section" : nominal.c_str(), 100 * reached.estimated.rms,
              100 * reached.left.rms);
  return reached;
}

class UnevenArm : public testing::TestWithParam<std::string> {};

TEST_P(UnevenArm, IsSteeredWhateverIsBelievedAndSeenAsItIsByTheFinerModel) {
  const Reached plain = servo(GetParam(), ""), fine = servo(GetParam(), "bend_profile = [1, 1, 1]"),
                right = servo(GetParam(), fmt::format("bend_profile = [{}, 1, {}]", 1 + uneven, 1 - uneven));
  // A shape of one arc per section does not fit the arm; one of three does.
  EXPECT_GT(plain.estimated.rms, 0.003);
  EXPECT_LT(fine.estimated.rms, 0.0015);
  EXPECT_LT(right.estimated.rms, 0.0015);
  EXPECT_LT(plain.left.rms, 0.03);
  EXPECT_LT(fine.left.rms, 0.03);
  // The target is reachable if the distribution of the bend is known.
  EXPECT_LT(right.left.rms, 0.004);
}

INSTANTIATE_TEST_SUITE_P(Laws, UnevenArm, testing::Values("shape", "points", "silhouettes"));

TEST(UnevenArmLearning, GoesByWhatIsLearnedOfTheDrivesToo) {
  const Reached learned = servo("points\"\njacobian = \"recursive",
                                fmt::format("bend_profile = [{}, 1, {}]", 1 + uneven, 1 - uneven));
  EXPECT_LT(learned.left.rms, 0.006);
}

// Calibrated, servoed, recorded and exported.
TEST(UnevenArmExample, FindsHowItsSectionsBend) {
  const TemporaryFolder folder;
  Quiet quiet;
  const RunResult result = run_experiment(
      load_experiment(checkout_file("examples/08_uneven_arm/experiment.toml")), folder.path(), quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  for (const Node& one : *result.summary.find("servos")->as<Node::Array>())
    EXPECT_LT(*one.find("remaining_in_truth")->find("rms")->as<double>(), 0.004);
  const Experiment found = load_experiment(folder.path() / "rig.toml");
  constexpr std::array truth = {0.4, 0.3, 0.2};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double>& profile = *found.arm.section[i].bend_profile;
    ASSERT_EQ(profile.size(), 3U);
    const std::array shall = {(1 + truth[i]) / 3, 1.0 / 3, (1 - truth[i]) / 3};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(profile[k], shall[k], 0.06) << i << ", " << k;
  }
  const ExportResult exported = export_csv(folder.path(), task_tables());
  const std::string table = read_text_file(exported.folder / "truth.csv", 1 << 26);
  EXPECT_TRUE(table.starts_with("time,arc_1_x,arc_1_y,arc_1_z,arc_2_x"));
  EXPECT_EQ(std::ranges::count(table.substr(0, table.find('\n')), ','), 3 * 10 + 4);
  EXPECT_GT(std::ranges::count(table, '\n'), 500);
}

// An arm that bends slightly unevenly is calibrated with one arc per section: the best-fit rig is taken, and
// the summary states that it does not fit.
TEST(UnevenArmExample, IsCalibratedAsNearlyOneArcASectionWithANote) {
  Experiment experiment = load_experiment(checkout_file("examples/08_uneven_arm/experiment.toml"),
                                          {{"task.0.images=8", "record.report=false"}, {}});
  experiment.task.resize(1);
  for (Section& section : experiment.arm.section) section.bend_profile.reset();
  for (Section& section : experiment.truth->arm->section) section.bend_profile = {1.2, 1, 0.8};
  const TemporaryFolder folder;
  Quiet quiet;
  const RunResult result = run_experiment(experiment, folder.path(), quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node& calibration = result.summary.find("calibrations")->as<Node::Array>()->front();
  EXPECT_GT(*calibration.find("rms")->as<double>(), 1.2);
  const Node& last = calibration.find("notes")->as<Node::Array>()->back();
  EXPECT_NE(last.as<std::string>()->find("The arm may bend differently"), std::string::npos);
}

// With a model of one arc per section, its observations have no explanation, and no rig must be returned.
TEST(UnevenArmExample, IsNotCalibratedAsAnArmOfOneArcASection) {
  Experiment experiment = load_experiment(checkout_file("examples/08_uneven_arm/experiment.toml"),
                                          {{"task.0.images=5", "record.report=false"}, {}});
  for (Section& section : experiment.arm.section) section.bend_profile.reset();
  const TemporaryFolder folder;
  Quiet quiet;
  const RunResult result = run_experiment(experiment, folder.path(), quiet);
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  EXPECT_NE(result.reasons.front().find("no rig explains the observations"), std::string::npos)
      << result.reasons.front();
  EXPECT_FALSE(std::filesystem::exists(folder.path() / rig_file_name));
}

}  // namespace
}  // namespace flexura
