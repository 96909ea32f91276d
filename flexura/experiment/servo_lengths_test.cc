// Servos of an arm whose sections stretch.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

class StretchingArm : public testing::TestWithParam<std::string> {};

TEST_P(StretchingArm, ComesToAShapeOfOtherLengths) {
  for (const bool are_lengths_given : {false, true}) {
    ServoSetup rig;
    rig.arm += "\nstretch_limits = [0.8, 1.3]\nmax_stretch_rate = 0.5";
    const std::string task = fmt::format(
        "law = \"{}\"\ntolerance = 0.003\nsettle = 0.5\n[[task.target]]\nbends = [[0.8, 0.3], [-0.7, 0.9], "
        "[1.0, -0.6]]\n{}",
        GetParam(), are_lengths_given ? "stretches = [1.2, 0.9, 1.1]\n" : "");
    ServoBench bench(servo_file(task, rig));
    const ServoResult result = bench.servo();
    ASSERT_TRUE(result.is_done) << result.reason;
    const auto goal = std::get<ArmState>(bench.config().goals.front().shape);
    const ServoError left = bench.truth(goal);
    EXPECT_LT(result.settled.value_or(10), 1.5);
    EXPECT_LT(left.rms, 0.005);
    const double step = bench.config().step;
    for (std::size_t i = 1; i < result.steps.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LE(std::abs(result.steps[i].sent.stretches[k] - result.steps[i - 1].sent.stretches[k]),
                  0.5 * step * (1 + 1e-9));
  }
}

INSTANTIATE_TEST_SUITE_P(By, StretchingArm,
                         testing::Values("shape", "points", "chords", "potential", "silhouettes"));

// The arm's second section changes its length by half of the command, unknown to the model.
TEST(StretchingArm, SaysWhichSectionIsStretchedAsFarAsItGoes) {
  ServoSetup rig;
  rig.arm += "\nstretch_limits = [0.8, 1.3]\nmax_stretch_rate = 0.5";
  ServoBench bench(
      servo_file("timeout = 2\n[[task.target]]\nbends = [[0.8, 0.3], [-0.7, 0.9], "
                 "[1.0, -0.6]]\nstretches = [1, 1.25, 1]\n",
                 rig));
  RigPorts ports = bench.ports();
  const auto with_share = [](ArmState state, double share) {
    state.stretches[1] = 1 + share * (state.stretches[1] - 1);
    return state;
  };
  AlteredArm lazy(
      *ports.arm,
      [&](ArmReading reading) {
        reading.state = with_share(reading.state, 2);
        return reading;
      },
      [&](const ArmState& state) { return with_share(state, 0.5); });
  ports.arm = &lazy;
  const ServoResult result = bench.servo(ports);
  EXPECT_FALSE(result.is_done);
  EXPECT_TRUE(std::ranges::any_of(result.steps, [](const ServoStep& step) {
    return step.limited == "section 2 is at its stretch limit";
  }));
}

}  // namespace
}  // namespace flexura
