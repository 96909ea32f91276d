#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/messages.h"
#include "tests/support/checkout.h"
#include "tests/support/runs.h"

// The example whose true arm is three elastic rods under their weight, with arcs as the tasks' model.
namespace flexura {
namespace {

class SaggingArmExample : public Runs, public testing::Test {};

double number_in(const Node& entry, const char* table, const char* name) {
  return *entry.find(table)->find(name)->as<double>();
}

TEST_F(SaggingArmExample, IsCalibratedAndSteeredIntoBothShapes) {
  const RunResult result =
      run(load_experiment(checkout_file("examples/10_sagging_arm/experiment.toml"), {{}, {}}));
  ASSERT_EQ(result.outcome, RunOutcome::done);
  EXPECT_TRUE(*entry_of(result, "calibrations").find("done")->as<bool>());
  for (const std::size_t servo : {0u, 1u}) {
    const Node& summary = entry_of(result, "servos", servo);
    EXPECT_TRUE(*summary.find("done")->as<bool>());
    EXPECT_LT(number_in(summary, "remaining_in_truth", "rms"), 0.01);
    EXPECT_GT(number_in(summary, "remaining_in_truth", "rms"), number_in(summary, "remaining", "rms") / 4);
  }
  // It sags: the rod's tip is centimetres from that of the commanded arcs.
  const auto truth = logged<PosesMessage>(result, arm_truth_topic);
  const auto sent = logged<PosesMessage>(result, arm_poses_topic);
  const VectorMessage is = truth.back().poses.back().position, was = sent.back().poses.back().position;
  EXPECT_GT(std::hypot(is.x - was.x, is.y - was.y, is.z - was.z), 0.01);
  EXPECT_FALSE(logged<TensionsMessage>(result, arm_tensions_topic).empty());
}

}  // namespace
}  // namespace flexura
