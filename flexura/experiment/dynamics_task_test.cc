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
#include "flexura/tasks/dynamics/dynamics_messages.h"
#include "tests/support/checkout.h"
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

// Random arms, starts, targets and gains that satisfy the theory's conditions.
std::string random_dynamics_file(TestRandom& random) {
  const bool is_planar = random.integer(0, 2) == 0;
  const int sections = random.integer(1, 3);
  const auto bends = [&] {
    std::string list;
    for (int i = 0; i < sections; ++i)
      list += fmt::format("{}[{}, {}]", i > 0 ? ", " : "", random.uniform(-0.6, 0.6),
                          is_planar ? 0 : random.uniform(-0.3, 0.3));
    return "bends = [" + list + "]\n";
  };
  std::string text =
      fmt::format("[record]\nreport = false\n[arm]\nkind = \"{}\"\n", is_planar ? "planar" : "spatial");
  // Otherwise shapes that a polynomial of few numbers cannot represent would jump at the start.
  const bool has_sections = random.integer(0, 1) == 0;
  if (has_sections) text += "initial." + bends();
  for (int i = 0; i < sections; ++i)
    text +=
        fmt::format("[[arm.section]]\nlength = {}\nstretch_limits = [0.5, 2]\n", random.uniform(0.2, 0.5));
  const bool has_lengths = random.integer(0, 3) == 0;
  text += fmt::format(
      "[[task]]\nkind = \"dynamics\"\nduration = 4\ndensity = {}\ngravity = [{}, {}, {}]\n"
      "bending_stiffness = {}\ndamping = {}\nbasis = \"{}\"\nnodes = {}\ntarget.{}",
      random.uniform(0.3, 1.5), random.uniform(-5, 5), random.uniform(-10, 10),
      is_planar ? 0 : random.uniform(-5, 5), random.uniform(0, 0.5), random.uniform(0, 0.3),
      has_sections ? "sections" : "polynomial", random.integer(1, 4), bends());
  text +=
      fmt::format("law.stiffness = [{}, {}]\nlaw.damping = [[{}, 0.5], [0.5, {}]]\nlaw.elasticity = \"{}\"\n",
                  random.uniform(10, 30), random.uniform(10, 30), random.uniform(2, 5), random.uniform(2, 5),
                  random.integer(0, 1) == 0 ? "cancelled" : "shaped");
  if (has_lengths) {
    text += "variable_lengths = true\naxial_stiffness = 30\ntarget.stretches = [";
    for (int i = 0; i < sections; ++i) text += fmt::format("{}, ", random.uniform(0.9, 1.1));
    text += "]\n";
  }
  return text;
}

TEST_F(Dynamics, LyapunovsFunctionFallsInAllThatIsLogged) {
  double rise = 0, imbalance = 0;
  for_random_cases(16, [&](TestRandom& random) {
    const std::string text = random_dynamics_file(random);
    SCOPED_TRACE(text);
    const RunResult result = run(text);
    EXPECT_EQ(result.outcome, RunOutcome::done) << testing::PrintToString(result.reasons);
    const std::vector<DynamicsSampleMessage> all = samples(result);
    ASSERT_EQ(all.size(), 201);
    const double first = all.front().lyapunov;
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_NEAR(all[i].time, 0.02 * static_cast<double>(i), 1e-12);
      EXPECT_EQ(all[i].lyapunov, all[i].kinetic_energy + all[i].potential);
      if (i > 0) rise = std::max(rise, (all[i].lyapunov - all[i - 1].lyapunov) / first);
      imbalance =
          std::max(imbalance,
                   std::abs(all[i].lyapunov + all[i].taken_by_law + all[i].taken_by_medium - first) / first);
    }
    EXPECT_LE(all.back().lyapunov, 1e-3 * first);
    EXPECT_LE(rise, 1e-12);
    EXPECT_LE(imbalance, 1e-6);
    EXPECT_LE(all.back().azimuth_error, 0.05);
    EXPECT_LE(all.back().elevation_error, 0.05);
  });
  std::printf("largest rise of W %.1e, largest imbalance %.1e of W at the start\n", rise, imbalance);
}

TEST_F(Dynamics, EachViolatedConditionFailsWithItsReason) {
  struct Violation {
    const char *set, *reported, *shown;
  };
  for (const Violation& violation :
       {Violation{"task.0.law.gravity_compensation=0", "0 % of gravity is compensated",
                  "gravity is not fully compensated: 100 % of it remains"},
        Violation{"task.0.law.gravity_compensation=0.7", "70 % of gravity is compensated",
                  "gravity is not fully compensated: 30 % of it remains"},
        Violation{"task.0.law.elasticity=\"ignored\"", "elasticity is neither cancelled nor part",
                  "the arm's elasticity is not fully compensated: 100 % of it remains"},
        Violation{"task.0.law.sign=-1", "has the sign -1, not +1",
                  "the force drives the arm away from the target"},
        Violation{"task.0.law.stiffness=[-5, 20]", "a stiffness k is not above 0",
                  "has no minimum at the target"},
        Violation{"task.0.law.damping=[[0, 0], [0, 0]]", "the damping K is not positive",
                  "damping removed no energy from the arm"},
        Violation{"task.0.law.damping=[[4, 0], [0, -0.05]]",
                  "the damping K is not positive definite: its least eigenvalue is -0.05",
                  "it added energy to the arm"}}) {
    SCOPED_TRACE(violation.set);
    // Without the medium's damping, which would hide the law's.
    const RunResult result = run(dynamics_arm() + dynamics_task("duration = 0.5\n" + bent_target),
                                 {violation.set, "task.0.damping=0", "record.report=false"});
    EXPECT_EQ(result.outcome, RunOutcome::failed);
    ASSERT_EQ(result.reasons.size(), 1);
    EXPECT_THAT(result.reasons[0], StartsWith("dynamics: "));
    EXPECT_THAT(result.reasons[0], HasSubstr(violation.reported));
    const Node& reported = dynamics(result);
    EXPECT_FALSE(truth(reported, "done"));
    EXPECT_THAT(write_json(*reported.find("violations")), HasSubstr(violation.reported));
    EXPECT_THAT(write_json(*reported.find("verdict")->find("reasons")), HasSubstr(violation.shown));
  }
}

// Finitely many drives produce all of the law's force if they move all coordinates, and W decreases as
// before. Otherwise the run must report the remainder.
TEST_F(Dynamics, FewDrivesAreAsGoodAsTheyMoveAllThatMoves) {
  const std::string all =
      dynamics_arm() + dynamics_task("duration = 4\nbasis = \"sections\"\n" + bent_target);
  const RunResult everywhere = run(all, {"record.report=false"});
  EXPECT_EQ(number(dynamics(everywhere), "left_over"), 0);
  for (const char* drives : {"torques", "moments"}) {
    SCOPED_TRACE(drives);
    const std::string set = fmt::format("task.0.law.drives=\"{}\"", drives);
    const RunResult driven = run(all, {set, "record.report=false"});
    EXPECT_EQ(driven.outcome, RunOutcome::done);
    EXPECT_LT(number(dynamics(driven), "left_over"), 1e-9);
    EXPECT_NEAR(number(*dynamics(driven).find("remaining"), "tip"),
                number(*dynamics(everywhere).find("remaining"), "tip"), 1e-7);
    const RunResult few = run(all, {set, "task.0.basis=\"polynomial\"", "task.0.nodes=6", "task.0.duration=1",
                                    "record.report=false"});
    EXPECT_EQ(few.outcome, RunOutcome::failed);
    EXPECT_THAT(few.reasons[0], HasSubstr("drives move an arm with 12 coordinates"));
    EXPECT_GT(number(dynamics(few), "left_over"), 0.01);
    EXPECT_FALSE(truth(*dynamics(few).find("verdict"), "balanced"));
  }
}

// W does not contain q then, so the energies reveal nothing; uncontrolled coordinates stay where they end up.
TEST_F(Dynamics, LeavesAloneWhatNoStiffnessLeads) {
  const RunResult result = run(dynamics_arm() + dynamics_task(bent_target), {"task.0.law.stiffness=[20, 0]"});
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  EXPECT_THAT(result.reasons, ElementsAre(HasSubstr("a stiffness k is not above 0")));
  EXPECT_TRUE(dynamics(result).find("verdict")->find("reasons")->as<Node::Array>()->empty());
  const auto all = samples(result);
  EXPECT_LT(all.back().azimuth_error, 1e-3);
  EXPECT_GT(all.back().elevation_error, 0.1);
}

// Only rounding remains of W, whatever other energies there are.
TEST_F(Dynamics, AnArmAtItsTargetIsThereWithoutWeightToo) {
  for (const char* off : {"0", "1e-8", "-1e-7"}) {
    const std::string target = fmt::format("target.bends = [[0.5, 0], [0.4, 0], [{}, 0]]\n", off);
    const RunResult result =
        run(dynamics_arm() + dynamics_task("target.bends = [[0.5, 0], [0.4, 0], [0, 0]]\n") +
                dynamics_task("duration = 1\n" + target),
            {"task.0.gravity=[0, 0, 0]", "task.1.gravity=[0, 0, 0]", "record.report=false"});
    EXPECT_EQ(result.outcome, RunOutcome::done) << off << ": " << testing::PrintToString(result.reasons);
  }
}

// The accepted final W is relative, also for weak springs in strong gravity.
TEST_F(Dynamics, IsDoneByItsOwnEnergyAlone) {
  const RunResult result =
      run(dynamics_arm() + dynamics_task("duration = 0.5\nlaw.stiffness = 0.1\n" + bent_target),
          {"task.0.gravity=[0, -10000, 0]", "record.report=false"});
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  const auto all = samples(result);
  EXPECT_GT(all.back().lyapunov, 1e-3 * all.front().lyapunov);
}

TEST_F(Dynamics, EndsWhereAnAngleIsNone) {
  const RunResult result =
      run(dynamics_arm() + dynamics_task("law.sign = -1\n" + bent_target) + "[[task]]\nkind = \"hold\"\n");
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  ASSERT_FALSE(result.reasons.empty());
  EXPECT_THAT(result.reasons.back(), HasSubstr("|q| reached 90 deg at "));
  const double end = number(dynamics(result), "duration");
  EXPECT_LT(end, 5);
  EXPECT_EQ(number(result.summary, "duration"), end);  // Later tasks are not done.
  const auto events = logged<EventMessage>(result, events_topic);
  EXPECT_EQ(events[events.size() - 2].level, 4);
  EXPECT_THAT(events[events.size() - 2].message, HasSubstr("|q| reached 90 deg"));
  EXPECT_EQ(events.back().message, "failed");
  EXPECT_EQ(samples(result).back().time, end);
  EXPECT_EQ(logged<ArmStateMessage>(result, arm_state_topic).back().time, end);
}

TEST_F(Dynamics, CannotStartWhereAnAngleIsNone) {
  const RunResult result =
      run("[arm]\nkind = \"spatial\"\ninitial.bends = [[0, -2]]\n[[arm.section]]\nlength = 1\n" +
          dynamics_task("target.bends = [[0.3, 0]]\n"));
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  EXPECT_THAT(
      result.reasons,
      ElementsAre("dynamics: the arm starts with an elevation of 90 deg, where the azimuth is undefined"));
  EXPECT_EQ(number(result.summary, "duration"), 0);
}

TEST_F(Dynamics, AMotionThatIsTooShortHasNotSettled) {
  const RunResult result = run(dynamics_arm() + dynamics_task("duration = 0.3\n" + bent_target));
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  EXPECT_THAT(result.reasons, ElementsAre("dynamics: W has not settled yet"));
  EXPECT_EQ(run(dynamics_arm() + dynamics_task("duration = 0.3\ntolerance = 1\n" + bent_target)).outcome,
            RunOutcome::done);
}

TEST_F(Dynamics, TellsWhatItsBasisCannotHave) {
  const std::string text = dynamics_arm() + dynamics_task("target.bends = [[1, 0], [-1, 0], [0, 0.5]]\n");
  const RunResult result = run(text, {"task.0.basis=\"polynomial\"", "task.0.nodes=2"});
  EXPECT_GT(number(dynamics(result), "target_off"), 0.05);
  EXPECT_EQ(number(dynamics(result), "start_off"), 0);
  EXPECT_THAT(text_of(result, report_file_name), HasSubstr("error for the requested target is"));
  EXPECT_LT(
      number(dynamics(run(text, {"task.0.basis=\"polynomial\"", "task.0.nodes=10", "task.0.duration=0.1"})),
             "target_off"),
      0.05);
}

TEST_F(Dynamics, ReportsDelayAndNoise) {
  const std::string text =
      dynamics_arm() + dynamics_task("duration = 4\ntolerance = 0.01\n" + bent_target +
                                     "measurement = { delay_ms = 60, noise_deg = 0.5 }\n");
  const RunResult result = run(text);
  EXPECT_EQ(result.outcome, RunOutcome::done) << testing::PrintToString(result.reasons);
  const Node& reported = dynamics(result);
  EXPECT_TRUE(truth(reported, "measured"));
  const Node& verdict = *reported.find("verdict");
  EXPECT_FALSE(truth(verdict, "monotone"));
  EXPECT_FALSE(truth(verdict, "balanced"));
  EXPECT_TRUE(truth(verdict, "settled"));
  // Largest rise from any logged time to a later one.
  double least = HUGE_VAL, rise = 0;
  for (const DynamicsSampleMessage& sample : samples(result)) {
    least = std::min(least, sample.lyapunov);
    rise = std::max(rise, sample.lyapunov - least);
  }
  EXPECT_EQ(number(verdict, "largest_rise"), rise);
  EXPECT_GT(rise, 0);
  const std::string page = text_of(result, report_file_name);
  EXPECT_THAT(page, HasSubstr(fmt::format("largest rise {:.2g} J", rise)));
  EXPECT_THAT(page, HasSubstr("The law used measured angles"));
  // With a larger delay it must fail.
  const RunResult late = run(text, {"task.0.measurement.delay=0.4", "record.report=false"});
  EXPECT_EQ(late.outcome, RunOutcome::failed);
  EXPECT_GT(number(*dynamics(late).find("verdict"), "largest_rise"), 100 * rise);
}

// The paper's law: two plane errors, gravity compensation and damping, on the arm of the theory.
TEST_F(Dynamics, GoesByTheErrorsInTwoImagePlanes) {
  const std::string text =
      dynamics_arm() +
      dynamics_task("duration = 5\ntolerance = 0.01\n" + bent_target +
                    "measurement = { reading = \"planes\", delay_ms = 60, step = 0.0333 }\n");
  const RunResult result = run(text);
  EXPECT_EQ(result.outcome, RunOutcome::done) << testing::PrintToString(result.reasons);
  EXPECT_EQ(number(dynamics(result), "triangulated"), 0);
  const std::vector<DynamicsSampleMessage> all = samples(result);
  EXPECT_GT(all.front().spatial_error, 0.2);
  EXPECT_LT(all.back().spatial_error, 2e-3);
  EXPECT_EQ(number(*dynamics(result).find("remaining"), "spatial"), all.back().spatial_error);
  // It differs from the law that measures the angles themselves, and ends at the same target.
  const RunResult read = run(text, {"task.0.measurement.reading=\"angles\"", "record.report=false"});
  EXPECT_EQ(read.outcome, RunOutcome::done);
  EXPECT_EQ(number(dynamics(read), "triangulated"), 0);
  const std::vector<DynamicsSampleMessage> by_angles = samples(read);
  EXPECT_GT(std::abs(all[20].spatial_error - by_angles[20].spatial_error), 1e-5);
  // With noise, and past a quarter turn of the azimuth, where both pictures have to be triangulated.
  const RunResult far = run(text, {"task.0.target.bends=[[1.2, -0.3], [0.8, 0.2], [0.3, -0.2]]",
                                   "task.0.measurement.noise_deg=0.3"});
  EXPECT_EQ(far.outcome, RunOutcome::done) << testing::PrintToString(far.reasons);
  EXPECT_GT(number(dynamics(far), "triangulated"), 0.05);
  EXPECT_LT(number(*dynamics(far).find("remaining"), "spatial"), 0.02);
  EXPECT_THAT(text_of(far, report_file_name), HasSubstr("were triangulated from both pictures"));
}

// The arm rises by a radian along its one section, and the azimuth is off by half of that. The azimuth's
// error counts less towards the tip: by sqrt(3 int_0^1 u^2 cos^2 u du).
TEST_F(Dynamics, AzimuthsCountByTheCosineOfTheElevationInSpace) {
  const std::string task = "[[task]]\nkind = \"dynamics\"\nduration = 6\n";
  const RunResult result = run("[arm]\nkind = \"spatial\"\n[[arm.section]]\nlength = 1\n" + task +
                               "target.azimuths = [0, 0]\ntarget.elevations = [0, 1]\n" + task +
                               "target.azimuths = [0, 0.5]\ntarget.elevations = [0, 1]\n");
  ASSERT_EQ(result.outcome, RunOutcome::done) << testing::PrintToString(result.reasons);
  const std::vector<DynamicsSampleMessage> all = samples(result);
  const auto second =
      std::ranges::find_if(all, [](const auto& sample) { return sample.azimuth_error > 0.1; });
  ASSERT_NE(second, all.end());
  EXPECT_LT(second->elevation_error, 1e-3);
  const double share = std::sqrt(3 * (1.0 / 6 + 0.5 * (std::sin(2) / 4 + std::cos(2) / 2)));
  EXPECT_NEAR(second->spatial_error / second->azimuth_error, share, 1e-3);
}

// The straight way to the target is free; that of an arm pulled down by its weight is not.
TEST_F(Dynamics, ItsTrueMotionIsJudgedBeforeItIsPlayed) {
  const std::string text =
      "[[obstacle]]\nkind = \"plane\"\nname = \"table\"\npoint = [0, 0.6, 0]\nignore_base = 0.65\n" +
      replaced(dynamics_arm(), "[[arm", "initial.bends = [[0.2, 0], [0.2, 0], [0, 0]]\n[[arm") +
      dynamics_task("target.bends = [[-0.2, 0], [0.1, 0], [0, 0]]\nlaw.stiffness = 2\n");
  const std::vector<std::string> falls = {"task.0.law.gravity_compensation=0", "task.0.density=2"};
  Quiet quiet;
  const Experiment held = parse_experiment(text, "x.toml"),
                   let_go = parse_experiment(text, "x.toml", {falls, {}});
  EXPECT_TRUE(check_experiment_safety(held, quiet).is_safe());
  EXPECT_TRUE(Schedule(let_go).check().is_safe());
  const SafetyReport report = check_experiment_safety(let_go, quiet);
  EXPECT_FALSE(report.is_safe());
  EXPECT_THAT(report.violations.front().text(), HasSubstr("table"));
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("dynamics: 0 % of gravity is compensated")));
  const RunResult result = run(text, falls);
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  EXPECT_THAT(result.reasons.front(), HasSubstr("table"));
  EXPECT_THAT(result.reasons.back(), HasSubstr("gravity"));
}

// Elasticity pulls towards a straight arm by itself, and is then part of the potential.
TEST_F(Dynamics, MayIgnoreElasticityOnTheWayToAStraightArm) {
  const RunResult result =
      run(replaced(dynamics_arm(), "[[arm", "initial.bends = [[0.5, -0.3], [0.4, 0.2], [0.3, -0.2]]\n[[arm") +
              dynamics_task("target.bends = [[0, 0], [0, 0], [0, 0]]\nlaw.elasticity = \"ignored\"\n"),
          {"task.0.bending_stiffness=2", "record.report=false"});
  EXPECT_EQ(result.outcome, RunOutcome::done) << testing::PrintToString(result.reasons);
  EXPECT_TRUE(dynamics(result).find("violations")->as<Node::Array>()->empty());
  const Node& verdict = *dynamics(result).find("verdict");
  EXPECT_TRUE(truth(verdict, "monotone") && truth(verdict, "balanced") && truth(verdict, "settled"));
}

TEST_F(Dynamics, TheExampleDoesWhatItSays) {
  const RunResult result = run(load_experiment(checkout_file("examples/07_theory/experiment.toml")));
  EXPECT_EQ(result.outcome, RunOutcome::done) << testing::PrintToString(result.reasons);
  EXPECT_TRUE(truth(*dynamics(result, 0).find("verdict"), "monotone"));
  EXPECT_FALSE(truth(dynamics(result, 0), "measured"));
  EXPECT_FALSE(truth(*dynamics(result, 1).find("verdict"), "monotone"));
  EXPECT_TRUE(truth(dynamics(result, 1), "measured"));
}

}  // namespace
}  // namespace flexura
