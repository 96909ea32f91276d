// Runs of an arm with a drive: the command list in addition to the log, and the mechanism that follows it.
#include "flexura/experiment/drive_commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "flexura/base/table.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"
#include "flexura/kinematics/tendons.h"
#include "tests/support/checkout.h"
#include "tests/support/drives.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path laboratory_arm = checkout_file("examples/02_laboratory_arm/experiment.toml");

struct Row {
  double time = 0;
  std::vector<std::int64_t> positions;
  std::vector<double> rates;
};

class LaboratoryArm : public ::testing::Test, public Runs {
 protected:
  static std::vector<Row> rows_of(const std::filesystem::path& results, std::size_t axes) {
    std::istringstream table(read_text_file(results / commands_file_name, 1 << 26));
    std::string line;
    std::getline(table, line);
    std::vector<Row> rows;
    while (std::getline(table, line)) {
      std::istringstream cells(line);
      std::string cell;
      std::getline(cells, cell, ',');
      Row& row = rows.emplace_back(Row{std::stod(cell), {}, {}});
      for (std::size_t i = 0; i < axes && std::getline(cells, cell, ','); ++i)
        row.positions.push_back(std::stoll(cell));
      while (std::getline(cells, cell, ',')) row.rates.push_back(std::stod(cell));
    }
    return rows;
  }
};

TEST_F(LaboratoryArm, RunsToTheSameBytesFromItsOwnFile) {
  const RunResult first = run(load_experiment(laboratory_arm));
  EXPECT_EQ(first.outcome, RunOutcome::done) << (first.reasons.empty() ? "" : first.reasons[0]);
  const auto files = files_in(first.folder);
  EXPECT_TRUE(files.contains("commands.csv"));
  EXPECT_EQ(files, files_in(run(load_experiment(first.folder / experiment_file_name)).folder));
}

TEST_F(LaboratoryArm, CommandsEveryStepOfTheClockWhateverIsLogged) {
  Experiment experiment = load_experiment(laboratory_arm);
  experiment.record.every = 100;
  const Schedule schedule(experiment);
  const RunResult result = run(experiment);
  EXPECT_THAT(read_text_file(result.folder / commands_file_name, 1 << 26),
              HasSubstr("time,1.1,1.2,1.3,1.4,2.1,2.2,2.3,2.4,3.1,1.1_rate,"));
  const std::vector<Row> rows = rows_of(result.folder, 9);
  ASSERT_EQ(rows.size(), schedule.steps() + 1);
  for (std::size_t step = 0; step < rows.size(); ++step) {
    ASSERT_EQ(rows[step].time, schedule.time_of_step(step));
    ASSERT_EQ(rows[step].positions.size(), 9U);
    ASSERT_EQ(rows[step].rates.size(), 9U);
    for (std::size_t i = 0; step > 0 && i < 9; ++i) {
      const auto moved = static_cast<double>(rows[step].positions[i] - rows[step - 1].positions[i]);
      EXPECT_NEAR(rows[step].rates[i], moved / (rows[step].time - rows[step - 1].time), 1e-9);
    }
  }
  EXPECT_THAT(rows.front().positions, ::testing::Each(0));
}

TEST_F(LaboratoryArm, FollowsItsCommandsToHalfAMicrostepThroughThePlay) {
  const Experiment experiment = load_experiment(laboratory_arm);
  const Schedule schedule(experiment);
  const Arm arm = experiment.arm.arm();
  const Drive drive = experiment.drive->drive();
  const std::vector<Row> rows = rows_of(run(experiment).folder, 9);
  BacklashModel mechanism(drive, rows.front().positions);
  for (const Row& row : rows) {
    mechanism.follow(row.positions);
    const ArmState desired = schedule.state_at(row.time);
    const TendonDisplacements needed = tendon_displacements(arm, drive, desired);
    const TendonDisplacements made = mechanism.displacements();
    for (std::size_t i = 0; i < 9; ++i) {
      ASSERT_LE(std::abs(made.pulled[i] - needed.pulled[i]) * drive.axes[i].microsteps_a_metre(), 0.5 + 3e-6)
          << "axis " << i << " at " << row.time << " s";
    }
    // Half a microstep is a micrometre of cable, 14 mm from the backbone.
    const ArmState found = fit_state(arm, drive, made).state;
    for (std::size_t i = 0; i < 3; ++i) ASSERT_LE((found.bends[i] - desired.bends[i]).norm(), 1e-4);
  }
}

// Compares the commands of a motor in commands.csv with its limits: single microsteps in rows too short for
// one are accepted with a caveat.
::testing::AssertionResult keeps_to(const std::vector<Row>& rows, std::size_t axis,
                                    const StepperMotor& motor) {
  const double most =
      std::min(motor.max_step_rate, motor.max_speed * motor.resolution() / (2 * std::numbers::pi));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto position = static_cast<double>(rows[k].positions[axis]);
    if (std::abs(position) > motor.max_position)
      return ::testing::AssertionFailure() << "position " << position;
    if (k == 0) continue;
    const double rate = std::abs(rows[k].rates[axis]);
    const bool is_single = std::abs(rows[k].positions[axis] - rows[k - 1].positions[axis]) <= 1;
    if (rate > most * (1 + 1e-9) && !is_single)
      return ::testing::AssertionFailure()
             << rate << " microsteps/s at " << rows[k].time << " s, limit " << most;
  }
  return ::testing::AssertionSuccess();
}

TEST_F(LaboratoryArm, ASafeListKeepsToTheLimitsOfItsMotors) {
  Experiment experiment = load_experiment(laboratory_arm);
  const std::vector<Row> all = rows_of(run(experiment).folder, 9);
  double fastest = 0;
  for (const Row& row : all)
    for (const double rate : row.rates) fastest = std::max(fastest, std::abs(rate));
  int safe = 0;
  constexpr int limits = 8;
  for (int k = 0; k < limits; ++k) {
    // Around the fastest row of the list, less than one microstep per row away from it.
    const double limit = fastest + (k - 0.5 * (limits - 1)) * 0.3 / experiment.clock.step;
    experiment.drive->motor.max_step_rate = limit;
    const RunResult result = run(experiment);
    const bool is_within = limit >= fastest;
    EXPECT_EQ(result.outcome, is_within ? RunOutcome::done : RunOutcome::unsafe)
        << limit << " of " << fastest;
    if (result.outcome != RunOutcome::done) continue;
    ++safe;
    const std::vector<Row> rows = rows_of(result.folder, 9);
    const Drive drive = experiment.drive->drive();
    for (std::size_t i = 0; i < 9; ++i) EXPECT_TRUE(keeps_to(rows, i, drive.axes[i].motor)) << "axis " << i;
  }
  EXPECT_EQ(safe, limits / 2);
}

TEST_F(LaboratoryArm, LogsTheCommandsOfItsTable) {
  const RunResult result = run(load_experiment(laboratory_arm));
  const std::vector<Row> rows = rows_of(result.folder, 9);
  std::size_t count = 0;
  for (const auto& command : logged<DriveCommandsMessage>(result, drive_commands_topic)) {
    ASSERT_LT(count, rows.size());
    EXPECT_EQ(command.time, rows[count].time);
    EXPECT_EQ(command.positions, rows[count].positions);
    EXPECT_EQ(command.rates, rows[count].rates);
    ++count;
  }
  EXPECT_EQ(count, rows.size());
}

TEST_F(LaboratoryArm, WritesNoCommandsForAMotionThatIsUnsafeOrWithoutADrive) {
  Experiment experiment = load_experiment(laboratory_arm);
  experiment.arm.section[1].max_bend = 0.1;
  const RunResult unsafe = run(experiment);
  EXPECT_EQ(unsafe.outcome, RunOutcome::unsafe);
  EXPECT_FALSE(std::filesystem::exists(unsafe.folder / commands_file_name));
  experiment = load_experiment(laboratory_arm);
  experiment.drive.reset();
  const RunResult bare = run(experiment);
  EXPECT_EQ(bare.outcome, RunOutcome::done);
  EXPECT_FALSE(std::filesystem::exists(bare.folder / commands_file_name));
  EXPECT_FALSE(logged_counts(bare).contains(std::string(drive_commands_topic)));
}

}  // namespace
}  // namespace flexura
