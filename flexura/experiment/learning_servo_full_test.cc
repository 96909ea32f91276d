// Servos that learn the arm's response to its drives.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>
#include <string>

#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

const ArmState desired = {{{0.8, 0.3}, {-0.7, 0.9}, {1.0, -0.6}}, {1, 1, 1}};

class LearningServo : public testing::TestWithParam<std::string> {};

// For an arm that follows its model, learning must not worsen the result. The arm gets as near and as fast,
// even to targets a rad and more away in each section.
TEST_P(LearningServo, IsAsGoodAsTheModelWhereThatIsRight) {
  const std::string far = "[[task.target]]\nbends = [[-1.0, 1.1], [1.15, -0.3], [-0.9, -1.1]]\n";
  for (const std::string& target : {servo_target, far}) {
    ServoBench bench(servo_file(
        fmt::format("law = \"points\"\ntolerance = 0.002\nsettle = 1\njacobian = \"{}\"\n", GetParam()) +
        target));
    const ServoResult result = bench.servo();
    ASSERT_TRUE(result.is_done) << result.reason;
    const auto goal = std::get<ArmState>(bench.config().goals.front().shape);
    std::printf("settled in %.2f s, %.4f %% of the length left\n", result.settled.value_or(-1),
                100 * bench.truth(goal).rms);
    EXPECT_LT(bench.truth(goal).rms, 0.002);
    EXPECT_LT(*result.settled, 4);
  }
}

// A servo of an arm whose drives are mounted a quarter turn from the model, and bend it 1.3 times as far.
ServoResult servo_of_turned_arm(ServoBench& bench) {
  RigPorts ports = bench.ports();
  TurnedArm turned(*ports.arm, std::numbers::pi / 2, 1.3);
  ports.arm = &turned;
  return bench.servo(ports);
}

TEST_P(LearningServo, SteersAnArmOfWhichTheModelIsWrong) {
  for (const std::string law : {"shape", "points"}) {
    ServoBench bench(servo_file(
        fmt::format("law = \"{}\"\njacobian = \"{}\"\ntolerance = 0.002\nsettle = 1\n", law, GetParam()) +
        servo_target));
    const ServoResult result = servo_of_turned_arm(bench);
    ASSERT_TRUE(result.is_done) << law << ": " << result.reason;
    std::printf("%s: settled in %.2f s, %.4f %% of the length left\n", law.c_str(),
                result.settled.value_or(-1), 100 * bench.truth(desired).rms);
    EXPECT_LT(bench.truth(desired).rms, 0.003);
    EXPECT_LT(*result.settled, 4);
  }
}

INSTANTIATE_TEST_SUITE_P(Both, LearningServo, testing::Values("broyden", "recursive"));

// With the model's derivatives, the arm does not get anywhere.
TEST(Servo, IsLostWithAModelThatIsWrong) {
  ServoBench bench(servo_file("timeout = 1\n" + servo_target));
  EXPECT_FALSE(servo_of_turned_arm(bench).is_done);
  EXPECT_GT(bench.truth(desired).rms, 0.05);
}

}  // namespace
}  // namespace flexura
