// Experiments on a rig with another implementation: the player and the tasks use only its interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "flexura/experiment/run.h"
#include "flexura/log/messages.h"
#include "flexura/rig/rig.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "tests/support/quiet.h"
#include "tests/support/runs.h"
#include "tests/support/servo_files.h"

namespace flexura {
namespace {

using ::testing::Contains;
using ::testing::Key;
using ::testing::Not;

// Like real equipment: a rig without a known truth.
class SilentRig : public Rig {
 public:
  SilentRig(const Setup& setup, int& passes) : rig_(simulated_rig(setup)), passes_(passes) {}

  [[nodiscard]] RigPorts ports() override { return rig_->ports(); }
  void play_to(double time, const ArmState& state, const TakeFrame& take) override {
    ++passes_;
    rig_->play_to(time, state, take);
  }
  void pass_to(double time, const ArmState& state) override {
    ++passes_;
    rig_->pass_to(time, state);
  }
  void skip_to_now() override { rig_->skip_to_now(); }

 private:
  std::unique_ptr<Rig> rig_;
  int& passes_;
};

TEST(OtherRig, DoesATaskOfWhichNobodyKnowsTheTruth) {
  const Experiment experiment = parse_experiment(
      servo_file(servo_target) + "[[task]]\nkind = \"hold\"\nduration = 0.5\n[record]\nreport = true\n",
      "x.toml");
  Quiet quiet;
  TemporaryFolder folder;
  int passes = 0, rigs = 0;
  const RigFactory make_rig = [&](const auto& setup) {
    ++rigs;
    return std::make_unique<SilentRig>(setup, passes);
  };
  const RunResult result = run_experiment(experiment, folder.path(), quiet, nullptr, make_rig);
  EXPECT_EQ(result.outcome, RunOutcome::done);
  EXPECT_EQ(rigs, 1);
  EXPECT_GT(passes, 10) << "the hold's steps";
  const auto counts = logged_counts(result);
  EXPECT_THAT(counts, Contains(Key(std::string(arm_reading_topic))));
  EXPECT_THAT(counts, Not(Contains(Key(std::string(arm_truth_topic)))));
  for (const auto& step : logged<ServoStep>(result, servo_steps_topic)) {
    EXPECT_FALSE(step.truth);
  }
  const Node& servo = entry_of(result, "servos");
  EXPECT_NE(servo.find("remaining"), nullptr);
  EXPECT_EQ(servo.find("remaining_in_truth"), nullptr);
}

// Harmful motions must be checked without moving it.
TEST(OtherRig, DoesNotMoveWhereTheMotionIsUnsafe) {
  const std::string unsafe = "[[task]]\nkind = \"move\"\nto = { bends = [[3, 0], [0, 0], [0, 0]] }\n";
  for (const bool has_servo : {false, true}) {
    std::string text = servo_file(servo_target) + unsafe;
    if (!has_servo) text = "[record]\ncameras = true\n" + text.erase(text.find("[[task]]")) + unsafe;
    Quiet quiet;
    TemporaryFolder folder;
    int passes = 0;
    const RigFactory make_rig = [&](const auto& setup) { return std::make_unique<SilentRig>(setup, passes); };
    const RunResult result =
        run_experiment(parse_experiment(text, "x.toml"), folder.path(), quiet, nullptr, make_rig);
    EXPECT_EQ(result.outcome, RunOutcome::unsafe);
    EXPECT_EQ(passes, 0);
    EXPECT_EQ(logged_counts(result).count(std::string(arm_reading_topic)), 0U);
    // A simulated rig shows what would happen.
    TemporaryFolder other;
    EXPECT_EQ(run_experiment(parse_experiment(text, "x.toml"), other.path(), quiet).outcome,
              RunOutcome::unsafe);
  }
}

TEST(OtherRig, IsNotAskedForWhereNothingPlays) {
  const Experiment experiment = parse_experiment(
      "[arm]\nkind = \"planar\"\n[[arm.section]]\nlength = 1\n[[task]]\nkind = \"hold\"\nduration = 0.1\n",
      "x.toml");
  Quiet quiet;
  TemporaryFolder folder;
  const RigFactory none = [](const auto&) -> std::unique_ptr<Rig> {
    ADD_FAILURE() << "a rig is asked for";
    return nullptr;
  };
  EXPECT_EQ(run_experiment(experiment, folder.path(), quiet, nullptr, none).outcome, RunOutcome::done);
}

}  // namespace
}  // namespace flexura
