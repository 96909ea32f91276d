// The kinds of tasks: their motions, and errors of invalid ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "flexura/base/degree.h"
#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"
#include "flexura/kinematics/shape.h"
#include "tests/support/experiment_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const std::string two_sections = "[[arm.section]]\nlength = 1\n[[arm.section]]\nlength = 1\n";

Experiment experiment_of_task(const std::string& task) {
  return parse_experiment(two_sections + "[[task]]\n" + task, "x.toml");
}

std::string error_of_task(const std::string& task) {
  return error_of_file(two_sections + "[[task]]\n" + task);
}

std::vector<double> archings_at(const Experiment& experiment, double time) {
  return archings(Schedule(experiment).state_at(time));
}

TEST(Tasks, AMoveFollowsItsLaw) {
  const auto halfway = [](const std::string& law) {
    return archings_at(experiment_of_task("kind='move'\nduration=4\nto.archings=[1, -1]\n" + law), 1)[0];
  };
  EXPECT_DOUBLE_EQ(halfway(""), 0.25);
  EXPECT_DOUBLE_EQ(halfway("law='linear'\n"), 0.25);
  EXPECT_DOUBLE_EQ(halfway("law='minimum_jerk'\n"), 0.103515625);
  const auto each = archings_at(
      experiment_of_task("kind='move'\nduration=4\nto.archings=[1, -1]\nlaw=['minimum_jerk', 'linear']\n"),
      1);
  EXPECT_DOUBLE_EQ(each[0], 0.103515625);
  EXPECT_DOUBLE_EQ(each[1], -0.25);
}

TEST(Tasks, ATrapezoidFindsItsTime) {
  // The section with the largest motion bends by 2 rad (an arching of 1): at 0.5 rad/s and 1 rad/s^2, 0.5 s
  // up, 3.5 s constant, 0.5 s down.
  const Experiment experiment = experiment_of_task(
      "kind='move'\nlaw='trapezoid'\nmax_rate=0.5\nmax_acceleration=1\nto.archings=[1, -0.5]\n");
  const Schedule schedule(experiment);
  EXPECT_DOUBLE_EQ(schedule.duration(), 4.5);
  EXPECT_DOUBLE_EQ(archings(schedule.state_at(4.5))[1], -0.5);
  EXPECT_DOUBLE_EQ(schedule.legs()[0].motion->rates(0, 0, 4.5)->bend, 0.5);
}

TEST(Tasks, ATrapezoidKeepsTheLimitsOfEachSectionAndAllArriveTogether) {
  // Section 1 bends by 2 rad at 1 rad/s, section 2 by 1 rad at 0.25 rad/s: the second limits the rate. The
  // first may accelerate by 1 rad/s^2, the second by 2 rad/s^2: the first limits the acceleration.
  const Experiment experiment = experiment_of_task(
      "kind='move'\nlaw='trapezoid'\nmax_rate=[1, 0.25]\nmax_acceleration=[1, 2]\nto.archings=[1, -0.5]\n");
  const Schedule schedule(experiment);
  EXPECT_DOUBLE_EQ(schedule.duration(), 4.5);  // 0.5 s up, 3.5 s constant, 0.5 s down.
  const MotionPtr motion = schedule.legs()[0].motion;
  EXPECT_DOUBLE_EQ(motion->rates(0, 0, 4.5)->bend, 0.5);
  EXPECT_DOUBLE_EQ(motion->rates(1, 0, 4.5)->bend, 0.25);
  const double bend_after_speeding_up = schedule.state_at(0.5).bends[0].norm();
  EXPECT_DOUBLE_EQ(bend_after_speeding_up, 0.5 * 1 * 0.5 * 0.5);
}

TEST(Tasks, ATrapezoidWithNowhereToGoTakesNoTime) {
  EXPECT_EQ(Schedule(experiment_of_task(
                         "kind='move'\nlaw='trapezoid'\nmax_rate=1\nmax_acceleration=1\nto.archings=[0,0]\n"))
                .duration(),
            0);
}

TEST(Tasks, ASineSwingsCordAnglesAsAsked) {
  const Experiment experiment = experiment_of_task(
      "kind='sine'\nduration=3\nperiod=2\namplitude.cord_angles_deg=[10, 20]\nphase_deg=[0, 90]\n");
  const ArmState state = Schedule(experiment).state_at(0.5);
  const std::vector<double> cords = cord_angles(experiment.arm.arm(), state);
  // At a quarter of the period section 1 is at its full swing of 10 deg. Section 2, which started at its own,
  // is in the middle: 20 deg lower.
  EXPECT_NEAR(cords[0] / degree, 100, 1e-12);
  EXPECT_NEAR(cords[1] / degree, 70, 1e-12);
}

TEST(Tasks, ALawForOneSectionIsALawOfTheCordAngleItNames) {
  const Experiment experiment = experiment_of_task(
      "kind='move'\nduration=4\nto.cord_angles_deg=[100, 60]\nlaw=['minimum_jerk', 'linear']\n");
  const std::vector<double> cords = cord_angles(experiment.arm.arm(), Schedule(experiment).state_at(1));
  EXPECT_NEAR(cords[0] / degree, 90 + 0.103515625 * 10, 1e-12);
  EXPECT_NEAR(cords[1] / degree, 90 - 0.25 * 30, 1e-12);
  EXPECT_TRUE(Schedule(experiment).check().is_safe());
}

TEST(Tasks, KeyframesArePassedInTheirUnits) {
  const Experiment experiment = experiment_of_task(
      "kind='keyframes'\ncolumns=['time_ms', 'arching_2_deg', 'arching_1_deg', 'stretch_1']\n"
      "rows=[[0, 0, 0, 1], [500, 30, -60, 1.1], [1000, 0, 10, 1]]\n");
  const Schedule schedule(experiment);
  EXPECT_DOUBLE_EQ(schedule.duration(), 1.0);
  const ArmState state = schedule.state_at(0.5);
  EXPECT_NEAR(archings(state)[0], -std::numbers::pi / 3, 1e-15);
  EXPECT_NEAR(archings(state)[1], std::numbers::pi / 6, 1e-15);
  EXPECT_DOUBLE_EQ(state.stretches[0], 1.1);
  EXPECT_DOUBLE_EQ(state.stretches[1], 1.0);
}

TEST(Tasks, AnExpressionKnowsTimeAndSection) {
  const Experiment experiment =
      experiment_of_task("kind='expression'\nduration=2\narchings='0.1*i*sin(pi*t/T)'\n");
  EXPECT_NEAR(archings_at(experiment, 1)[0], 0.1, 1e-15);
  EXPECT_NEAR(archings_at(experiment, 1)[1], 0.2, 1e-15);
  const Experiment bends = parse_experiment(
      "arm.kind='spatial'\n" + two_sections +
          "[[task]]\nkind='expression'\nbends=[['t', '-t'], ['0', 't^2']]\nstretches='1+t/10'\n",
      "x.toml");
  const ArmState state = Schedule(bends).state_at(0.5);
  EXPECT_EQ(state.bends[0], Eigen::Vector2d(0.5, -0.5));
  EXPECT_EQ(state.bends[1], Eigen::Vector2d(0, 0.25));
  EXPECT_DOUBLE_EQ(state.stretches[1], 1.05);
}

TEST(Tasks, EachStartsWhereTheOneBeforeEnds) {
  const Experiment experiment =
      parse_experiment(two_sections +
                           "[[task]]\nkind='move'\nto.archings=[0.3, "
                           "0.1]\n[[task]]\nkind='sine'\nduration=0.25\namplitude.archings=[0.2, 0]\n"
                           "[[task]]\nkind='hold'\n",
                       "x.toml");
  EXPECT_DOUBLE_EQ(archings_at(experiment, 1)[0], 0.3);
  EXPECT_DOUBLE_EQ(archings_at(experiment, 2)[0], 0.5);
  EXPECT_TRUE(Schedule(experiment).check().is_safe());
}

TEST(Tasks, BadOnesGetAClearLine) {
  const std::vector<std::pair<const char*, const char*>> tasks{
      {"kind='move'\nlaw='jump'\nto.archings=[0,0]\n",
       "x.toml:7:5: task[0].law = \"jump\": expected one of \"linear\""},
      {"kind='move'\nlaw=['linear','linear','linear']\nto.archings=[0,0]\n",
       "task[0].law: 3 given: expected 1 value for all sections, or 2"},
      {"kind='move'\nlaw='trapezoid'\nto.archings=[0,0]\n",
       "task[0].max_rate: missing: the law trapezoid needs this key"},
      {"kind='move'\nlaw='trapezoid'\nmax_rate=1\nmax_acceleration=1\nduration=1\nto.archings=[0,0]\n",
       "x.toml:10:1: task[0].duration: the law trapezoid computes the duration"},
      {"kind='move'\nlaw='trapezoid'\nmax_rate=0\nmax_acceleration=1\nto.archings=[0,0]\n",
       "max_rate = 0: expected a number above 0 rad/s"},
      {"kind='move'\nlaw='trapezoid'\nmax_rate=[1,1,1]\nmax_acceleration=1\nto.archings=[0,0]\n",
       "x.toml:8:1: task[0].max_rate: 3 given: expected 1 value for all sections, or 2, one per section"},
      {"kind='move'\nmax_rate=1\nto.archings=[0,0]\n",
       "task[0].max_rate: applies only to law = \"trapezoid\""},
      {"kind='move'\nlaw=['trapezoid','linear']\nmax_rate=1\nmax_acceleration=1\nto.archings=[0,0]\n",
       "mixes trapezoid with other laws"},
      {"kind='sine'\n", "task[0].amplitude: missing: expected a table"},
      {"kind='sine'\namplitude.stretches=[1,1]\n", "task[0].amplitude.stretches: cannot oscillate"},
      {"kind='sine'\namplitude.archings=[1,1]\nperiod=0\n", "task[0].period = 0: expected a number from"},
      {"kind='keyframes'\ncolumns=['arching_1','arching_2']\n", "no column time"},
      {"kind='keyframes'\ncolumns=['time','arching_1']\nrows=[[0,0],[1,1]]\n",
       "no column arching_2: expected one column for each of 2 sections"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2','speed']\nrows=[]\n",
       "x.toml:7:41: task[0].columns[3]: unknown column \"speed\""},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2']\nrows=[]\n",
       "0 rows: expected at least 2"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2']\nrows=[[0,0,0],[2,0,0],[1,0,0]]\n",
       "task[0].rows[2][0]: time 1: expected more than the previous time, 2"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2']\nrows=[[0,0,0],[1e-320,1,0]]\n",
       "time 1e-320: expected at least 1e-09 s after the previous time, 0"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2']\nrows=[[0,0,0],[2e6,0,0]]\n",
       "task[0].rows[1][0]: time 2000000 s: expected at most 1000000 s"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2']\nrows=[[1,0,0],[2,0,0]]\n",
       "time 1: expected 0 in the first row"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2']\nrows=[[0,0,0],[2,0]]\n",
       "task[0].rows[1][0]: 2 values: expected 3"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2']\nrows=[[0,0,0],[2,0,nan]]\n",
       "task[0].rows[1][2] = nan: expected a finite number"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2','arching_3']\nrows=[[0,0,0,0],[2,0,0,0]]\n",
       "column arching_3: the arm has 2 sections"},
      {"kind='keyframes'\ncolumns=['time','arching_1','arching_2','arching_2']\nrows=[[0,0,0,0],[2,0,0,0]]\n",
       "column arching_2 occurs twice"},
      {"kind='keyframes'\nfile='a.csv'\ncolumns=['time']\n",
       "task[0].file: is given together with columns or rows"},
      {"kind='expression'\n", "task[0]: is empty: expected cord_angles"},
      {"kind='expression'\narchings='sin(t'\n", "x.toml:7:16: task[0].archings[0]: missing parenthesis"},
      {"kind='expression'\narchings = ['t', \"2*phi + 1\"]\n",
       "x.toml:7:21: task[0].archings[1]: unexpected token \"phi\""},
      {"kind='expression'\narchings='1/0'\n",
       "x.toml:7:1: task[0].archings[0]: \"1/0\" is inf at t = 0 s in section 1: expected a finite number"},
      {"kind='expression'\nduration=2\narchings=['t','sqrt(1-t)']\n",
       "x.toml:8:15: task[0].archings[1]: \"sqrt(1-t)\" is nan at t = 1.02 s in section 2: expected"},
      {"kind='move'\nto={}\n", "x.toml:7:1: task[0].to: is empty: expected a shape"},
      {"kind='move'\nname=\"a\\nunsafe\"\nto.archings=[0,0]\n",
       "x.toml:7:6: task[0].name = \"a unsafe\": expected a text on one line, without U+000A"},
      {"kind='keyframes'\n", "task[0]: is empty: expected file, or columns and rows"},
      {"kind='expression'\narchings='t = 3'\n", "x.toml:7:13: task[0].archings[0]: assigns a value"},
      {"kind='expression'\narchings=\"2*\\u0070hi\"\n",
       "x.toml:7:1: task[0].archings[0]: unexpected token \"phi\" at character 3 of \"2*phi\""},
      {"kind='expression'\narchings=['t','t','t']\n", "task[0].archings: 3 given"},
      {"kind='expression'\narchings='phi'\n", "phi"},
      {"kind='expression'\narchings='t'\ncord_angles='t'\n", "more than one way"},
      {"kind='expression'\nbends=[['t','t']]\n", "task[0].bends[0]: leaves the plane"},
  };
  for (const auto& [task, error] : tasks) EXPECT_THAT(error_of_task(task), HasSubstr(error)) << task;
}

TEST(Tasks, AFormulaWithoutAValueBetweenTheTimesTriedIsUnsafeNotACrash) {
  for (const char* hole : {"1/abs(t-0.505)", "sqrt(abs(t-0.505)-0.001)", "ln(abs(t-0.505)-0.002)"}) {
    const Experiment experiment =
        parse_experiment(std::string("[clock]\nstep = 0.005\n") + two_sections +
                             "[[task]]\nkind = 'expression'\narchings = 't*" + hole + "'\n",
                         "x.toml");
    const std::string formula = hole;
    const SafetyReport report = Schedule(experiment).check();
    EXPECT_FALSE(report.is_safe()) << formula;
    std::string all;
    for (const Violation& violation : report.violations) all += violation.text() + "\n";
    EXPECT_THAT(all, HasSubstr("no possible value")) << formula;
  }
}

TEST(Tasks, ALawThatStartsElsewhereJumps) {
  const Experiment experiment = experiment_of_task("kind='expression'\narchings='0.2+t'\n");
  const SafetyReport report = Schedule(experiment).check();
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_EQ(report.violations[0].text(), "at 0 s: expression: section 1: jump 22.9183 deg");
  EXPECT_THAT(report.caveats.at(0), HasSubstr("sampled every 0.02 s"));
}

TEST(Keyframes, AreReadFromAFileBesideTheExperimentAndKeptInTheExperimentAsRun) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "x.toml";
  std::ofstream(file) << two_sections
                      << "[[task]]\nkind = 'keyframes'\nfile = 'wave.csv'\ninterpolation = 'smooth'\n";
  std::ofstream(folder.path() / "wave.csv") << "time,arching_1,arching_2\n0,0,0\n1,0.5,-0.5\n2,0,0\n";
  const Experiment experiment = load_experiment(file);
  EXPECT_DOUBLE_EQ(archings_at(experiment, 1)[1], -0.5);
  const Experiment again = parse_experiment(experiment_toml(experiment), "as-run.toml");
  EXPECT_EQ(experiment_toml(again), experiment_toml(experiment));
  EXPECT_DOUBLE_EQ(archings_at(again, 1.3)[1], archings_at(experiment, 1.3)[1]);
}

TEST(Keyframes, BadFilesAreReportedAtTheirLine) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "x.toml";
  const auto error_with = [&](const std::string& name, const std::string& csv) {
    std::ofstream(file) << two_sections << "[[task]]\nkind = 'keyframes'\nfile = '" << name << "'\n";
    std::ofstream(folder.path() / "wave.csv") << csv;
    try {
      (void)load_experiment(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string header = "time,arching_1,arching_2\n";
  EXPECT_THAT(error_with("wave.csv", ""), HasSubstr("wave.csv:1:1: empty: expected a line of column names"));
  EXPECT_THAT(error_with("wave.csv", header), HasSubstr("wave.csv:1:1: 0 rows: expected at least 2"));
  EXPECT_THAT(error_with("wave.csv", header + "0,0,0\n\n2,0,0\n1,0,0\n"),
              HasSubstr("wave.csv:5:1: column time: time 1: expected more"));
  EXPECT_THAT(error_with("wave.csv", header + "0,0,0\n1, 0, 501\n"),
              HasSubstr("wave.csv:3:6: column arching_2: angle 501 rad: expected from -500 rad to 500 rad"));
  EXPECT_THAT(error_with("wave.csv", "\n arching_1 ,\"arching_2\",time\n0,0,0\n1,0,0\n\n1,0,-2\n"),
              HasSubstr("wave.csv:4:5: column time: time 0: expected more than the previous time, 0\n"));
  EXPECT_THAT(error_with("wave.csv", "\n\ntime,arching_1,arching_3\n0,0,0\n1,0,0\n"),
              HasSubstr("wave.csv:3:16: column arching_3: the arm has 2 sections"));
  EXPECT_THAT(error_with("wave.csv", header + "0,0,0\n"), HasSubstr("wave.csv:1:1: 1 row: expected"));
  EXPECT_THAT(error_with("wave.csv", header + "0,0,0\n1,0,x\n"),
              HasSubstr("wave.csv:3:5: \"x\": expected a finite number"));
  EXPECT_THAT(
      error_with("wave.csv", "time;arching_1;arching_2\n0;0,0;0\n1;0,5;0\n"),
      HasSubstr("wave.csv:1:5: columns are separated by ';': expected commas, and points in numbers"));
  EXPECT_THAT(error_with("none.csv", ""), HasSubstr("x.toml:7:8: task[0].file: no file \"none.csv\""));
  EXPECT_THAT(error_with("../x.csv", ""), HasSubstr("is outside the experiment's folder"));
}

TEST(Keyframes, AMissingFileHidesNoOtherError) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "x.toml";
  std::ofstream(folder.path() / "bad.csv") << "time\n";
  const std::string keyframes = "[[task]]\nkind = 'keyframes'\nfile = ";
  const auto problems = [&](const std::string& tasks) {
    std::ofstream(file) << two_sections << tasks;
    try {
      (void)load_experiment(file);
    } catch (const InputError& error) {
      return error.problems().size();
    }
    return std::size_t{0};
  };
  EXPECT_EQ(problems(keyframes + "'no.csv'\n[[task]]\nkind = 'expression'\narchings = 'sin('\n" + keyframes +
                     "'none.csv'\n"),
            3U);
  EXPECT_GE(problems(keyframes + "'bad.csv'\n" + keyframes + "'bad.csv'\n"), 2U)
      << "files that are there, and bad";
}

}  // namespace
}  // namespace flexura
