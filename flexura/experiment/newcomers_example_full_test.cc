#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "tests/support/checkout.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

// Wrong cameras are calibrated, then the arm is servoed through three shapes and along a path.
TEST(NewcomersExample, CalibratesItsCamerasAndReachesItsShapes) {
  const std::filesystem::path file = checkout_file("examples/06_shape_servo/experiment.toml");
  const TemporaryFolder folder;
  Quiet quiet;
  const RunResult result = run_experiment(load_experiment(file), folder.path(), quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node::Array& servos = *result.summary.find("servos")->as<Node::Array>();
  ASSERT_EQ(servos.size(), 3U);
  for (const Node& servo : servos) {
    EXPECT_TRUE(*servo.find("done")->as<bool>());
    // Share of the length, by the simulated truth.
    EXPECT_LT(*servo.find("remaining_in_truth")->find("rms")->as<double>(), 0.002);
  }
}

}  // namespace
}  // namespace flexura
