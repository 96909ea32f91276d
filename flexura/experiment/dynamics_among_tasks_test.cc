#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/export_csv.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/dynamics/dynamics_run.h"
#include "flexura/tasks/task_kinds.h"
#include "tests/support/dynamics_files.h"
#include "tests/support/dynamics_runs.h"
#include "tests/support/experiment_files.h"
#include "tests/support/quiet.h"
#include "tests/support/random_cases.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(Dynamics, IsTheSameByteForByteOfOneSeed) {
  const std::string text =
      "title = \"x\"\n" + dynamics_arm() +
      dynamics_task("duration = 0.5\n" + bent_target + "measurement = { delay = 0.05, noise = 0.01 }\n");
  const RunResult first = run(text);
  const auto files = files_in(first.folder);
  EXPECT_TRUE(files_in(run(text).folder) == files);
  EXPECT_TRUE(files.contains("figures/dynamics-1-lyapunov.svg"));
  const RunResult again = run(load_experiment(first.folder / experiment_file_name));
  EXPECT_TRUE(files_in(again.folder) == files);
  EXPECT_NE(samples(run(text, {"seed=2"})).back().lyapunov, samples(first).back().lyapunov);
}

TEST_F(Dynamics, GoesOnWhereTheTaskBeforeEndedAndTheNextGoesOnFromThere) {
  const RunResult result =
      run(dynamics_arm() +
          "[[task]]\nkind = \"move\"\nduration = 0.113\nto.bends = [[0.2, 0.1], [0, 0], [0, 0]]\n" +
          dynamics_task("name = \"law\"\nduration = 3.005\n" + bent_target) +
          "[[task]]\nkind = \"hold\"\nduration = 0.1\n");
  EXPECT_EQ(result.outcome, RunOutcome::done) << testing::PrintToString(result.reasons);
  EXPECT_EQ(number(dynamics(result), "start"), 0.113);
  const auto all = samples(result);
  EXPECT_EQ(all[0].time, 0.113);
  EXPECT_NEAR(all[1].time, 0.12, 1e-12);
  EXPECT_NEAR(all.back().time, 3.118, 1e-12);
  const auto states = logged<ArmStateMessage>(result, arm_state_topic);
  for (std::size_t i = 1; i < states.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(std::hypot(states[i].bends[k][0] - states[i - 1].bends[k][0],
                             states[i].bends[k][1] - states[i - 1].bends[k][1]),
                  0, 0.1);
  const std::vector<std::array<double, 2>> desired = {{0.5, -0.3}, {0.4, 0.2}, {0.3, -0.2}};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(states.back().bends[k][i], desired[k][i], 1e-3);
  EXPECT_EQ(states.back().bends, states[states.size() - 2].bends);
}

TEST_F(Dynamics, LogsEveryNthStateAndBothEnds) {
  const RunResult result =
      run(dynamics_arm() + dynamics_task("duration = 3.01\n" + bent_target), {"record.every=10"});
  const auto all = samples(result);
  ASSERT_EQ(all.size(), 17);  // At 0, 0.2, ... 3 and 3.01 s.
  for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(all[i].time, 0.2 * static_cast<double>(i), 1e-9);
  EXPECT_NEAR(all.back().time, 3.01, 1e-12);
}

TEST_F(Dynamics, IsExportedAsATable) {
  const RunResult result =
      run(dynamics_arm("planar") + dynamics_task("duration = 3\ntarget.archings_deg = [-20, 10, 5]\n"));
  const ExportResult exported = export_csv(result.folder, task_tables());
  std::ifstream table(exported.folder / "dynamics.csv");
  std::string head, line, last;
  std::getline(table, head);
  EXPECT_EQ(
      head,
      "time,kinetic_energy,gravity_energy,elastic_energy,potential,lyapunov,taken_by_law,taken_by_medium,"
      "azimuth_error,elevation_error,spatial_error,tip_error,tip_x,tip_y,tip_z");
  std::size_t rows = 0;
  for (; std::getline(table, line); ++rows) last = line;
  EXPECT_EQ(rows, samples(result).size());
  EXPECT_THAT(last, StartsWith("3,"));
  EXPECT_THAT(last, testing::EndsWith(",0"));  // A planar arm stays in its plane.
}

TEST_F(Dynamics, CanBeCancelledWhileItIsSimulated) {
  class Cancelled : public Quiet {
   public:
    [[nodiscard]] bool is_cancelled() const override { return true; }
  } cancelled;
  const RunResult result =
      run_experiment(parse_experiment(dynamics_arm() + dynamics_task(bent_target), "x.toml"),
                     make_new_folder(folder_.path() / "results"), cancelled);
  EXPECT_EQ(result.outcome, RunOutcome::cancelled);
  EXPECT_FALSE(open_log(result.folder).truncated());
}

// A long arm takes long from one sample to the next.
TEST_F(Dynamics, CanBeCancelledBetweenTwoSamples) {
  class CancelledSoon : public Quiet {
   public:
    void update(double fraction, std::string_view) override { reported_.push_back(fraction); }
    [[nodiscard]] bool is_cancelled() const override { return reported_.size() > 20; }
    [[nodiscard]] const std::vector<double>& reported() const { return reported_; }

   private:
    std::vector<double> reported_;
  } cancelled;
  const Experiment experiment =
      parse_experiment("[clock]\nstep = 5\n" + dynamics_arm() + dynamics_task(bent_target), "x.toml");
  const auto& task = std::get<DynamicsTask>(experiment.task[0]);
  const DynamicsRun run =
      run_dynamics(task, {"dynamics", 0}, experiment, Schedule(experiment).initial(), 0, cancelled);
  EXPECT_EQ(run.reason(), "cancelled");
  EXPECT_GT(run.samples.back().energies.time, 0);
  EXPECT_LT(run.samples.back().energies.time, 1);
  EXPECT_EQ(cancelled.reported().size(), 21);
  EXPECT_GT(cancelled.reported().back(), 0);
  EXPECT_LT(cancelled.reported().back(), 0.2);
}

// The run ends with the first failed task; known facts about later tasks must be reported.
TEST_F(Dynamics, TellsWhatIsWrongAfterATaskThatFailsToo) {
  const std::string text =
      dynamics_arm() + dynamics_task("name = \"first\"\nlaw.gravity_compensation = 0.5\n" + bent_target) +
      dynamics_task("name = \"second\"\nlaw.sign = -1\nlaw.elasticity = \"ignored\"\n" + bent_target) +
      dynamics_task("name = \"third\"\n" + bent_target);
  const Experiment experiment = parse_experiment(text, "x.toml", {{"record.report=false"}, {}});
  const auto is_reported = [](const std::vector<std::string>& caveats,
                              const std::vector<std::string>& notes) {
    for (const char* name : {"second", "third"})
      EXPECT_THAT(caveats,
                  testing::Contains(fmt::format("{}: only a straight path to the target is checked: the "
                                                "motion is not simulated, because the run ends with first",
                                                name)));
    EXPECT_THAT(notes, testing::Contains(HasSubstr("second: the potential's force has the sign -1")));
    EXPECT_THAT(notes, testing::Contains(HasSubstr("second: the arm's elasticity is neither")));
    EXPECT_THAT(notes, testing::Not(testing::Contains(StartsWith("third"))));
  };
  Quiet quiet;
  const SafetyReport report = check_experiment_safety(experiment, quiet);
  is_reported(report.caveats, report.notes);
  EXPECT_THAT(report.notes, testing::Contains("first: 50 % of gravity is compensated, not 100 %"));
  const RunResult result = run(experiment);
  const auto lines = [&](const char* key) {
    std::vector<std::string> texts;
    for (const Node& line : *result.summary.find(key)->as<Node::Array>())
      texts.push_back(*line.as<std::string>());
    return texts;
  };
  is_reported(lines("caveats"), lines("notes"));
  EXPECT_THAT(result.reasons, ElementsAre("first: 50 % of gravity is compensated, not 100 %"));
}

}  // namespace
}  // namespace flexura
