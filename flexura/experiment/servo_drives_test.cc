// Servos of an arm whose motors have limits: the commands must pass the check of the command list.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"
#include "tests/support/runs.h"
#include "tests/support/servo_bench.h"
#include "tests/support/servo_files.h"

namespace flexura {
namespace {

// Three tendons per section, on spools driven by steppers.
std::string drive_with(const std::string& motor, double backlash_deg = 0) {
  std::string text = "[drive]\nradius_mm = 14\ntendon = [";
  for (int section = 1; section <= 3; ++section)
    for (int i = 0; i < 3; ++i)
      text += fmt::format("{{ section = {}, angle_deg = {} }}, ", section, 40 * (section - 1) + 120 * i);
  return text + fmt::format(
                    "]\n[drive.motor]\nphases = 3\nsteps = 600\nmicrosteps = "
                    "10\n{}\n[drive.spool]\nradius_mm = 10\ngear = 10\nbacklash_deg = {}\n",
                    motor, backlash_deg);
}

// Expects success of an experiment, with a list for the motors.
void expect_done(const std::string& text) {
  Runs runs;
  const RunResult result = runs.run(text);
  for (const std::string& reason : result.reasons) ADD_FAILURE() << reason;
  EXPECT_EQ(result.outcome, RunOutcome::done);
  EXPECT_TRUE(std::filesystem::exists(result.folder / "commands.csv"));
}

struct SteeredMotors {
  const char* name;
  double clock_step;
  const char* motor;
  double backlash_deg;
};

class ServoWithDrive : public testing::TestWithParam<SteeredMotors> {};

TEST_P(ServoWithDrive, EndsSafeWithACommandList) {
  const auto& [name, clock_step, motor, backlash_deg] = GetParam();
  ServoSetup rig;
  rig.rest = drive_with(motor, backlash_deg);
  std::string text = servo_file("law = \"points\"\ntimeout = 60\n" + servo_target, rig);
  const std::string clock = "step = 0.05";
  text.replace(text.find(clock), clock.size(), fmt::format("step = {}", clock_step));
  expect_done(text);
}

INSTANTIATE_TEST_SUITE_P(
    Of, ServoWithDrive,
    testing::Values(SteeredMotors{"SuddenMotorsByAFineClock", 0.01, "max_acceleration = 1000", 0},
                    SteeredMotors{"SuddenMotorsByACoarseClock", 0.08, "max_acceleration = 300", 0},
                    SteeredMotors{"SlowMotors", 0.05, "max_speed_deg = 400", 0},
                    SteeredMotors{"WeakMotors", 0.05, "max_acceleration = 30", 0},
                    SteeredMotors{"MotorsWithPlay", 0.02, "max_speed_deg = 3600\nmax_acceleration = 1000",
                                  0.1}),
    [](const auto& one) { return std::string(one.param.name); });

// A law that requests more speed than its motors can brake would pass the target, farther each time.
TEST(ServoWithDrive, ArrivesWithoutOvershootHoweverWeakItsMotorsAre) {
  for (const char* law : {"shape", "potential"}) {
    SCOPED_TRACE(law);
    ServoSetup rig;
    rig.rest = drive_with("max_acceleration = 3");
    ServoBench bench(servo_file(fmt::format("law = \"{}\"\n", law) + servo_target, rig));
    const ServoResult result = bench.servo();
    ASSERT_TRUE(result.is_done) << result.reason;
    EXPECT_LT(result.overshoot, 0.02);
    EXPECT_LT(bench.truth(std::get<ArmState>(bench.config().goals.front().shape)).rms, 0.005);
  }
}

// The speed of a servo is unknown before it runs: slow motors must not keep it from starting.
TEST(ServoWithDrive, IsNotRefusedBecauseOfAWayThatNobodyGoes) {
  ServoSetup rig;
  rig.rest = drive_with("max_acceleration = 0.4");
  const Experiment experiment = parse_experiment(servo_file(servo_target, rig), "x.toml");
  EXPECT_TRUE(Schedule(experiment).check().is_safe());
}

// Readings of drives are rounded to their steps; the next task must begin where the last one sent them.
TEST(ServoWithDrive, GoesOnFromWhereTheTaskBeforeEnded) {
  ServoSetup rig;
  rig.rest = drive_with("max_acceleration = 1000", 0.1) +
             "[[task]]\nkind = \"move\"\nduration = 3\nlaw = \"minimum_jerk\"\nto.bends = [[0.123, 0.2], "
             "[0.1, 0.3], [0.4, 0]]\n";
  expect_done(servo_file(
      servo_target + "[[task]]\nkind = \"servo\"\n[[task.target]]\nbends = [[0.2, 0], [0.3, 0.1], [0, 0.4]]\n"
                     "[[task]]\nkind = \"move\"\nduration = 3\nlaw = \"minimum_jerk\"\n"
                     "to.bends = [[0, 0], [0, 0], [0, 0]]\n",
      rig));
}

}  // namespace
}  // namespace flexura
