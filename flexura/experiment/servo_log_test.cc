// Tests the content of a servo's log.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "flexura/servo/servo_step.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "tests/support/runs.h"
#include "tests/support/servo_files.h"

namespace flexura {
namespace {

// Every command to a head that follows must be in the log, and every stretch.
TEST(ServoLog, HasWhatHeadsAndStretchesWereSentTo) {
  const std::string task =
      "follow = true\nhold_after = 1\n[[task.target]]\nbends = [[1.2, 0.9], [0.8, 0.6], [0.2, 0.1]]\n"
      "stretches = [1.1, 1, 0.9]\n";
  ServoSetup rig;
  rig.sensor = "read_noise = 1, delay = 0.3, exposure = 0.002";
  rig.arm += "\nstretch_limits = [0.8, 1.2]";
  Runs runs;
  const RunResult result = runs.run(servo_file(task, rig));
  EXPECT_EQ(result.outcome, RunOutcome::done);
  std::size_t steps = 0, heads = 0;
  std::vector<double> stretches;
  for (const auto& step : logged<ServoStep>(result, servo_steps_topic)) {
    ++steps;
    ASSERT_EQ(step.sent.stretches.size(), 3U);
    if (steps == 1) {
      EXPECT_EQ(step.sent.stretches, (std::vector<double>{1, 1, 1}));
    }
    stretches = step.sent.stretches;
    heads += step.heads.size();
    for (const HeadCommand& head : step.heads) {
      EXPECT_TRUE(head.camera == "front" || head.camera == "side") << head.camera;
      EXPECT_TRUE(head.pan != 0 || head.tilt != 0);
    }
  }
  EXPECT_GT(steps, 20u);
  EXPECT_GT(heads, 0u);
  EXPECT_NEAR(stretches.at(0), 1.1, 0.01);
  EXPECT_NEAR(stretches.at(2), 0.9, 0.01);
}

// Returns the mean distance, px, of the pixels that the law compares from their targets.
double to_go(const ServoObservationMessage& observation) {
  double sum = 0;
  for (const FeatureMarkMessage& mark : *observation.features)
    sum += (Eigen::Vector2d(mark.seen.at(0)[0], mark.seen.at(0)[1]) -
            Eigen::Vector2d(mark.desired.at(0)[0], mark.desired.at(0)[1]))
               .norm();
  return sum / static_cast<double>(observation.features->size());
}

TEST(ServoLog, HasWhatTheLawCompares) {
  Runs runs;
  const RunResult result = runs.run(servo_file("law = \"points\"\npoints = 9\n" + servo_target));
  EXPECT_EQ(result.outcome, RunOutcome::done);
  const auto observations = logged<ServoObservationMessage>(result, servo_observations_topic);
  ASSERT_GT(observations.size(), 40u);
  for (const ServoObservationMessage& observation : observations) {
    ASSERT_TRUE(observation.features);
    EXPECT_EQ(observation.features->size(), 9u);
  }
  EXPECT_TRUE(std::filesystem::exists(result.folder / "figures" / "servo-1-errors.svg"));
  EXPECT_GT(to_go(observations.front()), 15);
  EXPECT_LT(to_go(observations.back()), 0.5);
}

// Four pixels cannot determine six bends.
TEST(ServoLog, HasWhereSomeMotionShowsInNothing) {
  for (const bool are_enough : {false, true}) {
    Runs runs;
    const std::string task =
        fmt::format("law = \"points\"\npoints = {}\ntimeout = 1\ntolerance = 0.002\n", are_enough ? 9 : 1);
    int fresh = 0, singular = 0;
    for (const auto& step : logged<ServoStep>(runs.run(servo_file(task + servo_target)), servo_steps_topic)) {
      fresh += step.is_fresh ? 1 : 0, singular += step.is_singular ? 1 : 0;
      if (step.is_fresh) {
        EXPECT_NE(step.is_singular, are_enough) << "at " << step.time << " s";
      }
    }
    EXPECT_GT(fresh, 20);
    EXPECT_EQ(singular > 0, !are_enough);
  }
}

// Ends of tasks are sums of durations, sometimes an ulp before the clock, also after these.
TEST(ServoLog, ManyServosFollowEachOther) {
  std::string tasks;
  for (int k = 0; k < 4; ++k)
    tasks += fmt::format(
        "{}settle = 0.9667\ntolerance = 0.05\n[[task.target]]\nbends_deg = [[{}, 0], [0, 0], [0, 0]]\n",
        k > 0 ? "[[task]]\nkind = \"servo\"\n" : "", k % 2 == 0 ? 10 : 0);
  std::string text = servo_file(tasks);
  const std::string clock = "[clock]\nstep = 0.05\n";
  text.erase(text.find(clock), clock.size());
  Runs runs;
  EXPECT_EQ(runs.run(text).outcome, RunOutcome::done);
}

}  // namespace
}  // namespace flexura
