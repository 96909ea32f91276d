// Servos of an arm whose motors have limits: what was sent passes the check of the command list.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/run.h"
#include "tests/support/quiet.h"
#include "tests/support/servo_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

// Three tendons a section, on spools that are wound by steppers.
std::string drive_with(const std::string& motor, double backlash_deg = 0) {
  std::string text = "[drive]\nradius_mm = 14\ntendon = [";
  for (int section = 1; section <= 3; ++section)
    for (int i = 0; i < 3; ++i)
      text += fmt::format("{{ section = {}, angle_deg = {} }}, ", section, 40 * (section - 1) + 120 * i);
  return text + fmt::format(
                    "]\n[drive.motor]\nphases = 3\nsteps = 600\nmicrosteps = "
                    "10\n{}\n[drive.spool]\nradius_mm = 10\ngear "
                    "= 10\nbacklash_deg = {}\n",
                    motor, backlash_deg);
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
  const TemporaryFolder folder;
  Quiet quiet;
  const RunResult result = run_experiment(parse_experiment(text, "x.toml"), folder.path(), quiet);
  for (const std::string& reason : result.reasons) ADD_FAILURE() << reason;
  EXPECT_EQ(result.outcome, RunOutcome::done);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "commands.csv"));
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

}  // namespace
}  // namespace flexura
