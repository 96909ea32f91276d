#include "flexura/experiment/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "flexura/base/degree.h"
#include "flexura/base/source.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/export_csv.h"
#include "flexura/model/backbone.h"
#include "flexura/tasks/task_kinds.h"
#include "tests/support/checkout.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::filesystem::path paper_arm = checkout_file("examples/01_paper_arm/experiment.toml");

class CountProgress : public Progress {
 public:
  void update(double fraction, std::string_view) override {
    EXPECT_GE(fraction, last_);
    EXPECT_LE(fraction, 1.0);
    last_ = fraction;
  }
  [[nodiscard]] double last() const { return last_; }

 private:
  double last_ = 0;
};

class Run : public ::testing::Test {
 protected:
  RunResult run(const Experiment& experiment) {
    CountProgress progress;
    return run_experiment(experiment, make_new_folder(folder_.path() / "results"), progress);
  }
  static std::array<double, 2> tip_of(const RunResult& result) {
    const auto& position = *result.summary.find("tip")->find("position")->as<Node::Array>();
    return {*position[0].as<double>(), *position[1].as<double>()};
  }
  TemporaryFolder folder_;
};

TEST(ExperimentAsRun, OfEveryExampleIsReadBackAsItIs) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(checkout_file("examples"))) {
    const std::filesystem::path file = entry.path() / "experiment.toml";
    if (!std::filesystem::exists(file)) continue;
    const std::string written = experiment_toml(load_experiment(file));
    EXPECT_EQ(experiment_toml(parse_experiment(written, "written.toml")), written) << file;
    ++count;
  }
  EXPECT_GE(count, 5U);
}

TEST_F(Run, ReachesThePapersEndEffector) {
  const RunResult result = run(load_experiment(paper_arm));
  EXPECT_EQ(result.outcome, RunOutcome::done);
  const auto [x, y] = tip_of(result);
  EXPECT_EQ(std::round(x * 1000), -10738);
  EXPECT_EQ(std::round(y * 1000), 5201);
  EXPECT_NEAR(x, -10.737859, 5e-7);
  EXPECT_NEAR(y, 5.201359, 5e-7);
}

TEST_F(Run, PassesThroughThePapersIntermediatePoses) {
  const Experiment experiment = load_experiment(paper_arm);
  const Schedule schedule(experiment);
  const Arm arm = experiment.arm.arm();
  const std::array<std::array<double, 3>, 3> expected{
      {{0.25, -4.343670, 15.116249}, {0.5, -7.924923, 12.648849}, {0.75, -10.152819, 9.106058}}};
  for (const auto& [fraction, x, y] : expected) {
    const Backbone backbone(arm, schedule.state_at(fraction * schedule.duration()));
    EXPECT_NEAR(backbone.tip().position.x(), x, 5e-7) << fraction;
    EXPECT_NEAR(backbone.tip().position.y(), y, 5e-7) << fraction;
  }
}

// Ends a run early, and keeps what it received.
class CancelAfter : public Progress, public RunWatcher {
 public:
  explicit CancelAfter(std::size_t states) : most_(states) {}
  void update(double, std::string_view) override {}
  [[nodiscard]] bool is_cancelled() const override { return times_.size() >= most_; }
  void state(double time, const ArmState& state, std::span<const CameraReading>) override {
    times_.push_back(time);
    last_ = state;
  }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] const ArmState& last() const { return last_; }

 private:
  std::size_t most_;
  std::vector<double> times_;
  ArmState last_;
};

TEST_F(Run, ThatIsCancelledLeavesWhatItHasComeTo) {
  const Experiment experiment = load_experiment(paper_arm);
  CancelAfter cancel(51);
  const RunResult result = run_experiment(experiment, folder_.path(), cancel, &cancel);
  EXPECT_EQ(result.outcome, RunOutcome::cancelled);
  EXPECT_EQ(*result.summary.find("outcome")->as<std::string>(), "cancelled");
  EXPECT_EQ(*result.summary.find("duration")->as<double>(), 1);
  EXPECT_EQ(cancel.times().size(), 51);
  EXPECT_EQ(cancel.last().bends, Schedule(experiment).state_at(1).bends);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / report_file_name));
  const McapReader log(folder_.path() / log_file_name);
  EXPECT_FALSE(log.truncated());
  EXPECT_THAT(std::string(log.messages().back().text()), HasSubstr("cancelled"));
}

TEST_F(Run, ThatIsCancelledAtOnceLeavesTheStart) {
  CancelAfter cancel(0);
  const RunResult result = run_experiment(load_experiment(paper_arm), folder_.path(), cancel);
  EXPECT_EQ(result.outcome, RunOutcome::cancelled);
  EXPECT_EQ(*result.summary.find("duration")->as<double>(), 0);
}

TEST_F(Run, ThatIsCancelledAtItsEndIsDone) {
  CancelAfter cancel(251);
  EXPECT_EQ(run_experiment(load_experiment(paper_arm), folder_.path(), cancel, &cancel).outcome,
            RunOutcome::done);
}

TEST_F(Run, WritesTheSameBytesFromItsOwnFileAndWatched) {
  const RunResult result = run(load_experiment(paper_arm));
  const auto files = files_in(result.folder);
  CancelAfter watcher(1000);
  const auto folder = make_new_folder(folder_.path() / "watched");
  (void)run_experiment(load_experiment(result.folder / experiment_file_name), folder, watcher, &watcher);
  EXPECT_EQ(files_in(folder), files);
  for (const char* name : {"log.mcap", "report.html", "figures/arm-end.svg"})
    EXPECT_TRUE(files.contains(name)) << name;
}

TEST_F(Run, NeverWritesIntoResultsThatExist) {
  const Experiment experiment = load_experiment(paper_arm);
  EXPECT_EQ(run(experiment).folder.filename(), "results");
  EXPECT_EQ(run(experiment).folder.filename(), "results-2");
  EXPECT_EQ(run(experiment).folder.filename(), "results-3");
}

TEST_F(Run, RefusesAnArmWithNothingToDo) {
  EXPECT_THROW((void)run(parse_experiment("[[arm.section]]\nlength = 1.0\n", "x.toml")), InputError);
}

constexpr const char* limited = R"(
[clock]
step = 0.1
[[arm.section]]
length = 1.0
max_bend_deg = 60
max_bend_rate_deg = 40
stretch_limits = [0.9, 1.2]
[[task]]
kind = "move"
duration = 2.0
to = { archings_deg = [30.0], stretches = [1.2] }
)";

TEST_F(Run, GoesToALimitButNotBeyond) {
  Experiment experiment = parse_experiment(limited, "x.toml");
  EXPECT_EQ(run(experiment).outcome, RunOutcome::done);
  auto& move = std::get<MoveTask>(experiment.task[0]);
  move.to.archings->at(0) = -31 * degree;
  RunResult result = run(experiment);
  EXPECT_EQ(result.outcome, RunOutcome::unsafe);
  ASSERT_THAT(result.reasons, SizeIs(1));
  EXPECT_EQ(result.reasons[0], "1.93548 s to 2 s: section 1: bend 62 deg, limit 60 deg");

  move.to.archings->at(0) = 0.1;
  move.to.stretches->at(0) = 0.8;
  EXPECT_THAT(run(experiment).reasons.at(0), HasSubstr("stretch 0.8, limit 0.9"));
  move.to = {};
  move.to.archings = {{0.5}};
  move.duration = 1.0;
  EXPECT_THAT(run(experiment).reasons.at(0), HasSubstr("bend rate 57.2958 deg/s, limit 40 deg/s"));
}

TEST_F(Run, SimulatesAnUnsafeMotionAndShowsIt) {
  Experiment experiment = parse_experiment(limited, "x.toml");
  std::get<MoveTask>(experiment.task[0]).to.archings->at(0) = 0.6;
  experiment.obstacle.emplace_back(SphereConfig{.name = "ball", .center = {0, 0.5, 0}, .radius = 0.1});
  const RunResult result = run(experiment);
  EXPECT_EQ(result.outcome, RunOutcome::unsafe);
  EXPECT_EQ(*result.summary.find("duration")->as<double>(), 2.0);
  const auto& violations = *result.summary.find("violations")->as<Node::Array>();
  ASSERT_THAT(violations, SizeIs(2));
  EXPECT_EQ(*violations[0].find("obstacle")->as<std::string>(), "ball");
  const std::string report = text_of(result, report_file_name);
  EXPECT_THAT(report, HasSubstr("section 1: contact with ball, "));
  EXPECT_THAT(report, HasSubstr("class=\"warning\""));
}

TEST_F(Run, ShowsViolationsAtTheirWorstMomentsBetweenTwoSteps) {
  const RunResult result =
      run(parse_experiment("[clock]\nstep = 0.2\n[[arm.section]]\nlength = 1\nmax_bend = 0.9\n[[task]]\n"
                           "kind = 'sine'\nduration = 0.6\nperiod = 1.2\namplitude.archings = [0.5]\n",
                           "x.toml"));
  ASSERT_THAT(result.reasons, SizeIs(1));
  const auto& violation = result.summary.find("violations")->as<Node::Array>()->at(0);
  EXPECT_NEAR(*violation.find("worst_time")->as<double>(), 0.3, 1e-9);
  const std::string report = text_of(result, report_file_name);
  EXPECT_THAT(report, HasSubstr("data-time=\"0.3\">0.300</button> " + result.reasons[0] + "</figcaption>"));
  EXPECT_THAT(report, HasSubstr("\"times\":[0,0.2,0.3,0.4,0.6]"));
  const std::string figure =
      read_text_file(result.folder / figures_folder_name / "arm-unsafe-1.svg", 1 << 24);
  EXPECT_THAT(figure, HasSubstr("class=\"warning\""));
}

TEST_F(Run, PlaysAFormulaUpToWhereItHasNoValue) {
  const RunResult result = run(parse_experiment(
      "[clock]\nstep = 0.03\n[[arm.section]]\nlength = 1\n[[task]]\nkind = 'expression'\nduration = 2\n"
      "archings = ['t * sqrt(abs(t - 1.11) - 0.005)']\n",
      "x.toml"));
  EXPECT_EQ(result.outcome, RunOutcome::unsafe);
  EXPECT_EQ(result.reasons.at(0), "at 1.11 s: expression: section 1: no possible value");
  EXPECT_DOUBLE_EQ(*result.summary.find("duration")->as<double>(), 1.08);
  EXPECT_EQ(result.summary.find("tasks"), nullptr);
}

TEST_F(Run, LogsTheLastStateWhateverTheRate) {
  Experiment experiment = parse_experiment(limited, "x.toml");
  experiment.record.every = 7;
  const McapReader log(run(experiment).folder / log_file_name);
  std::vector<std::uint64_t> times;
  for (const McapMessage& message : log.messages()) {
    if (message.channel->topic == "/arm/state") times.push_back(message.log_time);
  }
  EXPECT_THAT(times, ::testing::ElementsAre(0, 700000000, 1400000000, 2000000000));
}

TEST_F(Run, PicturesTheMiddleHoweverFewStatesAreRecorded) {
  Experiment experiment = load_experiment(paper_arm);
  const auto heading = [&] {
    const std::string svg = text_of(run(experiment), "figures/arm-middle.svg");
    const std::size_t tip = svg.find(">E(");
    return svg.substr(svg.find("middle, t = "), 20) + svg.substr(tip, svg.find('<', tip) - tip);
  };
  const std::string all = heading();
  EXPECT_THAT(all, HasSubstr("middle, t = "));
  EXPECT_THAT(all, HasSubstr(">E("));
  experiment.record.every = 1'000'000;
  EXPECT_EQ(heading(), all);
}

TEST_F(Run, KeepsWithinADurationThatIsNoWholeNumberOfSteps) {
  Experiment experiment = parse_experiment(limited, "x.toml");
  std::get<MoveTask>(experiment.task[0]).duration = 1.96;
  const Schedule schedule(experiment);
  EXPECT_EQ(schedule.steps(), 20U);
  EXPECT_DOUBLE_EQ(schedule.time_of_step(19), 1.9);
  EXPECT_DOUBLE_EQ(schedule.time_of_step(20), 1.96);
}

TEST_F(Run, MovesFromTaskToTaskWithoutAJump) {
  const Experiment experiment = parse_experiment(
      "[[arm.section]]\nlength = 1\n[arm.initial]\narchings = "
      "[0.1]\n[[task]]\nkind='move'\nto.archings=[0.5]\n"
      "[[task]]\nkind='hold'\n[[task]]\nkind='move'\nto.archings=[-0.5]\n",
      "x.toml");
  const Schedule schedule(experiment);
  double before = schedule.state_at(0).bends[0].x();
  EXPECT_DOUBLE_EQ(before, -0.2);
  for (int i = 1; i <= 3000; ++i) {
    const double now = schedule.state_at(i * 1e-3).bends[0].x();
    EXPECT_LE(std::abs(now - before), 2.001e-3) << i;
    before = now;
  }
  EXPECT_DOUBLE_EQ(before, 1.0);
}

TEST_F(Run, ExportsATableOfStatesAndOneOfEvents) {
  const RunResult result = run(load_experiment(paper_arm));
  const ExportResult exported = export_csv(result.folder, task_tables());
  EXPECT_TRUE(exported.notes.empty());
  std::istringstream states(read_text_file(exported.folder / "states.csv", 1 << 24));
  std::string line;
  std::string last;
  std::size_t rows = 0;
  std::getline(states, line);
  EXPECT_THAT(line, HasSubstr("time,arching_1,"));
  EXPECT_THAT(line, HasSubstr(",tip_x,tip_y,tip_z,"));
  const auto columns = std::ranges::count(line, ',');
  while (std::getline(states, last)) {
    ++rows;
    ASSERT_EQ(std::ranges::count(last, ','), columns);
  }
  EXPECT_EQ(rows, 251U);
  std::istringstream header(line);
  std::istringstream values(read_text_file(exported.folder / "states.csv", 1 << 24));
  for (std::size_t i = 0; i <= rows; ++i) std::getline(values, last);
  std::istringstream cells(last);
  std::map<std::string, double> row;
  for (std::string name, value; std::getline(header, name, ',') && std::getline(cells, value, ',');)
    row[name] = std::stod(value);
  EXPECT_DOUBLE_EQ(row.at("tip_x"), tip_of(result)[0]);
  EXPECT_DOUBLE_EQ(row.at("tip_y"), tip_of(result)[1]);
  EXPECT_DOUBLE_EQ(row.at("cord_angle_4"), std::numbers::pi);
  EXPECT_THAT(read_text_file(exported.folder / "events.csv", 1 << 20),
              ::testing::Eq("time,level,name,message\n0,info,bend,move starts\n5,info,run,done\n"));
}

TEST_F(Run, ExportsWhatACutLogStillHolds) {
  const RunResult result = run(load_experiment(paper_arm));
  const auto log = result.folder / log_file_name;
  std::filesystem::resize_file(log, std::filesystem::file_size(log) / 2);
  const ExportResult exported = export_csv(result.folder, task_tables());
  EXPECT_EQ(exported.notes.size(), 1U);
  const std::string states = read_text_file(exported.folder / "states.csv", 1 << 24);
  EXPECT_GT(std::ranges::count(states, '\n'), 50);
}

TEST_F(Run, ExportSaysWhenThereIsNoLog) {
  EXPECT_THROW((void)export_csv(folder_.path(), task_tables()), InputError);
}

TEST(DefaultResultsFolder, IsNamedAfterTheExperiment) {
  EXPECT_EQ(default_results_folder("a/my_arm.toml"), "results/my_arm");
  EXPECT_EQ(default_results_folder("a/01_paper_arm/experiment.toml"), "results/01_paper_arm");
}

TEST(MakeNewFolder, MakesFoldersAboveAndIgnoresATrailingSlash) {
  const TemporaryFolder folder;
  EXPECT_EQ(make_new_folder(folder.path() / "a/b/"), folder.path() / "a/b");
  EXPECT_EQ(make_new_folder(folder.path() / "a/b/"), folder.path() / "a/b-2");
  EXPECT_THROW((void)make_new_folder("/proc/nothing/here"), std::runtime_error);
}

TEST(Overrides, ChangeValuesUnderTheSameChecks) {
  const auto length = [](const std::string& set) {
    return load_experiment(paper_arm, {.sets = {set}, .seed = {}}).arm.section[0].length;
  };
  EXPECT_EQ(length("arm.section.0.length=2.5"), 2.5);
  EXPECT_EQ(load_experiment(paper_arm, {.sets = {}, .seed = 7}).seed, 7);
  const auto error = [&](const std::string& set) {
    try {
      (void)length(set);
    } catch (const InputError& caught) {
      return std::string(caught.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error("arm.section.0.length=-1"),
              HasSubstr(":1:22: arm.section[0].length = -1: expected a number from 1e-06 m"));
  EXPECT_THAT(error("arm.section.8.length=1"), HasSubstr("index 8 is outside an array of size 8"));
  EXPECT_THAT(error("arm.base.position.1=3"),
              HasSubstr("entry 1 cannot be set because the array does not exist"));
  EXPECT_THAT(error("arm.section.0.lenght=1"), HasSubstr("did you mean \"length\"?"));
  EXPECT_THAT(error("arm.section.0.length"), HasSubstr("expected path=value"));
  EXPECT_THAT(error("=1"), HasSubstr("is not a path"));
  EXPECT_THAT(error("seed=2\nx=1"), HasSubstr("--set seed=2: expected a single value on a single line"));
}

TEST(Overrides, AreToldOfAllAtOnce) {
  try {
    (void)load_experiment(paper_arm, {.sets = {"arm.section.8.length=1", "seed=3", "nothing"}, .seed = {}});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("index 8 is outside an array of size 8"));
    EXPECT_THAT(error.what(), HasSubstr("--set nothing: expected path=value"));
  }
}

}  // namespace
}  // namespace flexura
