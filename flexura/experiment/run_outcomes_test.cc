// Tests what a run says of its tasks: in its summary, its report and on the terminal.
#include "flexura/experiment/run_outcomes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/experiment/experiment.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/tasks/servo/servo_results.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string one_section = "[[arm.section]]\nlength = 1\n";

TaskOutcome servo(const std::string& name, bool is_done, double rms) {
  ServoRun run;
  run.name = name, run.result.is_done = is_done, run.result.reason = "the arm is out of sight";
  run.result.remaining = ServoError{.rms = rms};
  return servo_outcome(run);
}

CalibrationRun calibration(double sigma) {
  CalibrationRun run;
  run.name = "calibrate", run.cameras = {"front", "side"};
  run.result.is_done = true;
  run.required = {.angle = 0.02 * degree, .focal = {0.003, 0.003}, .zoom_ratio = 0.003};
  run.result.remainder.angle = -0.01 * degree;
  run.result.steps.emplace_back().sigmas = {
      .angle = sigma * degree, .focal = {0.001, 0.004}, .zoom_ratio = 0};
  return run;
}

RunResult run(const std::string& file, const TemporaryFolder& folder) {
  NoProgress progress;
  return run_experiment(parse_experiment(file, "x.toml"), make_new_folder(folder.path() / "results"),
                        progress);
}

TEST(TaskOutcome, OfSeveralTasksOfAKindIsCountedWithTheWorst) {
  const std::vector<TaskOutcome> all = {servo("bow", true, 0.0008), servo("swan", true, 0.0012)};
  EXPECT_EQ(all[0].text, "converged in 0.00 s, 0.08 % of the length rms");
  EXPECT_EQ(total_of(all), "2 of 2 servos converged, worst 0.12 % of the length rms");
  const std::vector<TaskOutcome> some = {all[0], servo("swan", false, 0.2)};
  EXPECT_EQ(total_of(some), "1 of 2 servos converged, worst 20 % of the length rms");
  EXPECT_THAT(some[1].line(), HasSubstr("swan: not converged: the arm is out of sight, 20 % of"));
  EXPECT_EQ(total_of({}), "");
}

TEST(TaskOutcome, OfACalibrationNamesWhatIsNotReached) {
  CalibrationRun run = calibration(0.05);
  TaskOutcome outcome = calibration_outcome(run);
  EXPECT_FALSE(outcome.is_reached);
  EXPECT_EQ(outcome.text,
            "axes 89.990 +- 0.05 degrees (required 0.02), focal length of side +- 0.4 % (required 0.3): not "
            "reached");
  run = calibration(0.01);
  run.result.steps.back().sigmas.focal[1] = 0.003;
  run.truth.emplace().angle = 0.002 * degree;
  outcome = calibration_outcome(run);
  EXPECT_TRUE(outcome.is_reached);
  EXPECT_EQ(outcome.text, "axes 89.990 +- 0.01 degrees (required 0.02): reached; true value: 90.002");
  run.result.is_done = false, run.result.reason = "no markers";
  EXPECT_EQ(calibration_outcome(run).text, "not calibrated: no markers");
}

TEST(TaskOutcome, OfALoopHasItsOffsets) {
  CalibrationRun run;
  run.name = "cylinder", run.accepted = 0.05;
  run.loop.emplace().is_done = true;
  run.loop->pictures = {7, 8}, run.loop->angle = 0.01 * degree;
  EXPECT_EQ(
      calibration_outcome(run).text,
      "offsets within 0.05 px after 15 pictures: reached; observed angle between the axes: 90.010 degrees");
}

TEST(TaskOutcome, LengthsAreReadable) {
  EXPECT_EQ(length_text(1e-9), "less than 0.001 mm");
  EXPECT_EQ(length_text(0.00081), "0.81 mm");
  EXPECT_EQ(length_text(0.163), "163 mm");
  EXPECT_EQ(length_text(1.234), "1.23 m");
}

TEST(RunOutcome, IsInSummaryAndReport) {
  const TemporaryFolder folder;
  const RunResult result =
      run(one_section +
              "[[task]]\nkind='move'\nname='to & fro'\nduration=0.2\nto.bends=[[0.5, 0]]\n"
              "[[task]]\nkind='sine'\nperiod=0.1\nduration=0.2\namplitude.bends=[[0.1,0]]\n"
              "[[task]]\nkind='hold'\nduration=0.1\n",
          folder);
  EXPECT_EQ(result.headline, "3 of 3 motions done");
  EXPECT_EQ(*result.summary.find("headline")->as<std::string>(), result.headline);
  const auto& outcomes = *result.summary.find("outcomes")->as<Node::Array>();
  ASSERT_EQ(outcomes.size(), 3U);
  EXPECT_EQ(*outcomes[0].find("task")->as<std::string>(), "to & fro");
  EXPECT_EQ(*outcomes[0].find("kind")->as<std::string>(), "move");
  EXPECT_TRUE(*outcomes[0].find("reached")->as<bool>());
  EXPECT_EQ(*outcomes[1].find("text")->as<std::string>(), "2 periods in 0.2 s");
  EXPECT_EQ(*outcomes[2].find("text")->as<std::string>(), "held for 0.1 s");
  const std::string page = read_text_file(folder.path() / "results/report.html", 1 << 24);
  EXPECT_THAT(page, HasSubstr("<p class=\"outcome\">3 of 3 motions done</p>"));
  EXPECT_THAT(page, HasSubstr("<strong>to &amp; fro</strong> at the target shape after 0.2 s"));
}

// An arm of steel that hangs bent, and whose tendons break. Periods of its stretch modes are far below the
// step.
std::string released_arm(double spectral_radius) {
  std::string text = fmt::format(
      "[arm]\nkind = 'spatial'\nmodel = 'dynamic'\ngravity = [0, -9.81, 0]\ntime_step = "
      "0.005\nspectral_radius = {}\n"
      "base = {{ position = [0, 0.9, 0], rotation = [0, 0, 0.7071067811865476, -0.7071067811865476] }}\n"
      "initial.bends_deg = [[60, 20]]\n"
      "[[arm.section]]\nlength = 0.4\nradius = 0.015\nmax_bend_deg = 150\nmax_bend_rate_deg = 20000\n"
      "material = {{ youngs_modulus = 2e11, poisson = 0.49, density = 8000, radius = 0.001, damping_time = 0 "
      "}}\n",
      spectral_radius);
  for (const int angle : {0, 120, 240})
    text +=
        fmt::format("[[arm.tendon]]\nsection = 1\nradius_mm = 12\nangle_deg = {}\nbreaks_at = 0.05\n", angle);
  return text + "[[task]]\nkind = 'hold'\nduration = 0.5\n";
}

// Without numerical damping the energy of these modes grows.
TEST(RunOutcome, WarnsOfAnEnergyThatGrows) {
  const TemporaryFolder folder, other;
  EXPECT_THAT(run(released_arm(1), folder).headline, HasSubstr("the energy of the arm grows"));
  EXPECT_THAT(run(released_arm(0.8), other).headline, Not(HasSubstr("energy")));
}

TEST(RunOutcome, OfAnUnsafeRunSaysSo) {
  const TemporaryFolder folder;
  const RunResult result =
      run(one_section + "[[task]]\nkind='move'\nduration=0.2\nto.position=[0, 3, 0]\n", folder);
  EXPECT_EQ(result.outcome, RunOutcome::unsafe);
  EXPECT_THAT(result.headline, HasSubstr("unsafe, only simulated: move: tip "));
  EXPECT_FALSE(result.outcomes.at(0).is_reached);
}

TEST(RunOutcome, OfACancelledRunHasWhatWasNotBegun) {
  // Stops the run after its first task.
  class Stop : public Progress {
   public:
    void update(double /*fraction*/, std::string_view what) override {
      is_over_ = is_over_ || what == "second";
    }
    [[nodiscard]] bool is_cancelled() const override { return is_over_; }

   private:
    bool is_over_ = false;
  } progress;
  const TemporaryFolder folder;
  const std::string hold = "[[task]]\nkind='hold'\nduration=1\nname=";
  const RunResult result = run_experiment(
      parse_experiment(one_section + hold + "'first'\n" + hold + "'second'\n" + hold + "'third'\n", "x.toml"),
      make_new_folder(folder.path() / "results"), progress);
  EXPECT_EQ(result.outcome, RunOutcome::cancelled);
  EXPECT_THAT(result.headline, HasSubstr("cancelled at "));
  EXPECT_THAT(result.headline, HasSubstr(" of 3 motions done"));
  EXPECT_EQ(result.outcomes.back().text, "not begun");
  EXPECT_FALSE(result.outcomes.back().is_reached);
}

}  // namespace
}  // namespace flexura
