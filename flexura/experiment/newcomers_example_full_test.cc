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

// Calibrates wrong cameras, then servos the arm to two or three shapes and along a path. `largest`: limit of
// the true error left, root mean square, share of the length.
void calibrate_and_servo(const std::string& example, double largest, std::size_t count = 3) {
  const std::filesystem::path file = checkout_file("examples/" + example + "/experiment.toml");
  const TemporaryFolder folder;
  Quiet quiet;
  const RunResult result = run_experiment(load_experiment(file), folder.path(), quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node::Array& servos = *result.summary.find("servos")->as<Node::Array>();
  ASSERT_EQ(servos.size(), count);
  for (const Node& servo : servos) {
    EXPECT_TRUE(*servo.find("done")->as<bool>());
    EXPECT_LT(*servo.find("remaining_in_truth")->find("rms")->as<double>(), largest);
  }
}

TEST(NewcomersExample, CalibratesItsCamerasAndReachesItsShapes) {
  calibrate_and_servo("06_shape_servo", 0.002);
}

// The arm is softer than its model, carries a load that the model lacks, and its tendons rub.
TEST(NewcomersExample, SteersAnArmThatSwings) { calibrate_and_servo("16_swinging_servo", 0.01); }

// Shelves, posts and cables are behind the arm.
TEST(NewcomersExample, SteersInFrontOfClutter) { calibrate_and_servo("18_clutter_servo", 0.005, 2); }

TEST(NewcomersExample, ClutterDefeatsTheFinderAlone) {
  const std::filesystem::path file = checkout_file("examples/18_clutter_servo/experiment.toml");
  const TemporaryFolder folder;
  Quiet quiet;
  Overrides overrides;
  overrides.sets = {"seeing=[]", "task[0].track=\"finder\"", "task[0].timeout=6"};
  const RunResult result = run_experiment(load_experiment(file, overrides), folder.path(), quiet);
  EXPECT_NE(result.outcome, RunOutcome::done);
}

}  // namespace
}  // namespace flexura
