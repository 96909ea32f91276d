#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/dynamics_files.h"
#include "tests/support/experiment_files.h"

namespace flexura {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

TEST(BadDynamics, EachIsOneClearLineAtItsPlace) {
  const std::string angles = "target.azimuths = [0, 1]\ntarget.elevations = [0, 0.5]\n";
  struct Bad {
    std::string lines, error;
  };
  for (const Bad& bad : {
           Bad{"", "task[0].target: missing"},
           Bad{"target = {}\n", "task[0].target: is empty: expected a shape"},
           Bad{"target = 3\n", "task[0].target = 3: expected a table"},
           Bad{bent_target + angles, "gives the shape in more than one way"},
           Bad{"target.azimuths = [0, 1]\n", "different numbers of azimuths and elevations"},
           Bad{"target.azimuths = [0, 1]\ntarget.elevations = [0, 0, 0]\n", "expected equal numbers"},
           Bad{"target.azimuths = [0, 0]\ntarget.elevations = []\n", "expected an array of 2 to"},
           Bad{"target.azimuths = [0, nan]\ntarget.elevations = [0, 0]\n", "nan: expected"},
           Bad{"target.azimuths = [0, inf]\ntarget.elevations = [0, 0]\n", "inf: expected"},
           Bad{"target.azimuths = [0, 1e9]\ntarget.elevations = [0, 0]\n", "from -50 rad to 50 rad"},
           Bad{"target.azimuths_deg = [0, 10]\ntarget.elevations_deg = [0, 90]\n",
               "task[0].target.elevations[1]: 90 deg: expected less than 90 deg, where the azimuth is "
               "undefined"},
           Bad{"target.azimuths_deg = [10, 10]\ntarget.elevations_deg = [0, 0]\n",
               "task[0].target.azimuths[0]: 10 deg: expected the value at the arm's clamped base, 0 deg"},
           Bad{"target.azimuths_deg = [0, 200]\ntarget.elevations_deg = [0, 0]\n",
               "task[0].target.azimuths[1]: 200 deg follows 0 deg: expected successive azimuths that differ "
               "by at most 180 deg; azimuths may exceed 180 deg"},
           Bad{"target.azimuths_deg = [0, 60, -190]\ntarget.elevations_deg = [0, 0, 0]\n",
               "task[0].target.azimuths[2]: -190 deg follows 60 deg"},
           Bad{"target.bends = [[0, 0]]\n", "task[0].target.bends: 1 given: expected 3"},
           Bad{"target.bends = [[0, 0], [0, -2], [0, 0]]\n", "passes through an elevation of 90 deg"},
           Bad{"target.bends = [[0, 2000], [0, 0], [0, 0]]\n",
               "expected a number from -1000 rad to 1000 rad"},
           Bad{"target.stretches = [1, 1.1, 1]\n", "target.stretches: requires variable_lengths = true"},
           Bad{"target.positions = [0, 0, 1]\n", "unknown key"},
           Bad{bent_target + "density = 0\n", "expected a number from 1e-06 to"},
           Bad{bent_target + "density = nan\n", "task[0].density = nan"},
           Bad{bent_target + "density = \"heavy\"\n", "task[0].density = \"heavy\": expected a number"},
           Bad{bent_target + "bending_stiffness = -1\n", "task[0].bending_stiffness = -1"},
           Bad{bent_target + "bending_stiffness = 1e300\n", "task[0].bending_stiffness = 1e+300"},
           Bad{bent_target + "damping = -1\n", "task[0].damping = -1"},
           Bad{bent_target + "duration = 0\n", "task[0].duration = 0: expected a number above 0 s"},
           Bad{bent_target + "duration = 1e9\n", "task[0].duration = 1000000000"},
           Bad{bent_target + "gravity = [0, -9.81]\n", "expected an array of 3"},
           Bad{bent_target + "gravity_g = [0, -1, 0]\n", "task[0].gravity_g"},
           Bad{bent_target + "basis = \"sines\"\n", "expected one of \"polynomial\", \"sections\""},
           Bad{bent_target + "nodes = 0\n", "task[0].nodes = 0"},
           Bad{bent_target + "nodes = 1000\n", "task[0].nodes = 1000"},
           Bad{bent_target + "law.damping = 4\n", "task[0].law.damping = 4: expected an array of 2"},
           Bad{bent_target + "law.damping = [[4, 0], [0, nan]]\n", "nan: expected"},
           Bad{bent_target + "law.stiffness = [1, 2, 3]\n", "task[0].law.stiffness"},
           Bad{bent_target + "law.stiffness = 1e300\n", "task[0].law.stiffness"},
           Bad{bent_target + "law.sign = 0\n", "task[0].law.sign: 0: expected 1 or -1"},
           Bad{bent_target + "law.sign = 2\n", "task[0].law.sign = 2"},
           Bad{bent_target + "law.elasticity = \"forgotten\"\n", "expected one of \"cancelled\", \"shaped\""},
           Bad{bent_target + "law.gravity_compensation = false\n", "expected a number"},
           Bad{bent_target + "law.stifness = 3\n", "did you mean \"stiffness\""},
           Bad{bent_target + "measurement = { reading = \"eyes\" }\n",
               "expected one of \"angles\", \"planes\""},
           Bad{bent_target + "measurement = { delay = -1 }\n", "task[0].measurement.delay = -1"},
           Bad{bent_target + "measurement = { delay = 1e6 }\n", "from 0 s to 60 s"},
           Bad{bent_target + "measurement = { noise = nan }\n", "task[0].measurement.noise = nan"},
           Bad{bent_target + "measurement = { step = 0 }\n", "task[0].measurement.step = 0"},
           Bad{bent_target + "tolerance = 0\n", "task[0].tolerance = 0"},
       }) {
    std::string text = dynamics_arm() + "[[task]]\nkind = \"dynamics\"\n" + bad.lines;
    const std::string error = error_of_file(text);
    EXPECT_THAT(error, HasSubstr(bad.error)) << bad.lines;
    EXPECT_THAT(error, MatchesRegex("x.toml:[0-9]+:[0-9]+: .*")) << bad.lines;  // No second line.
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  EXPECT_EQ(error_of_file(dynamics_arm() + dynamics_task(bent_target)), "no error");
  EXPECT_EQ(error_of_file(dynamics_arm() + dynamics_task(angles)), "no error");
}

// A polynomial that rises to 85 deg and stays there for a while exceeds it; straight lines do not.
TEST(BadDynamics, ATargetIsTheCurveThatThePolynomialMakesOfIt) {
  const auto error = [](const std::string& target, const std::string& basis, int nodes) {
    return error_of_file(dynamics_arm() +
                         dynamics_task(target + fmt::format("basis = \"{}\"\nnodes = {}\n", basis, nodes)));
  };
  const std::string angles = "target.azimuths_deg = [0, 0, 0, 0]\ntarget.elevations_deg = [0, 85, 85, -40]\n";
  EXPECT_EQ(error(angles, "sections", 3), "no error");
  EXPECT_THAT(
      error(angles, "polynomial", 4),
      MatchesRegex(
          "x.toml:[0-9]+:[0-9]+: task\\[0\\].target: passes, as a polynomial \\(nodes = 4\\), through "
          "an elevation of [0-9.]+ deg: expected less than 90 deg, where the azimuth is undefined"));
  EXPECT_EQ(error(angles, "polynomial", 5), "no error");
  // With bends too.
  const std::string bends = "target.bends = [[0, -1.5], [0, 0], [0, 0]]\n";
  EXPECT_EQ(error(bends, "sections", 3), "no error");
  EXPECT_THAT(error(bends, "polynomial", 4),
              HasSubstr("task[0].target: passes, as a polynomial (nodes = 4)"));
  EXPECT_EQ(error(bends, "polynomial", 5), "no error");
}

TEST(BadDynamics, WholeTurnsOfAzimuthsAreNone) {
  const auto error = [](const std::string& arm, const std::string& azimuths) {
    return error_of_file(
        arm + dynamics_task("target.elevations_deg = [0, 0, 0]\ntarget.azimuths_deg = " + azimuths + "\n"));
  };
  // For an arm that hangs, the base's azimuth is half a turn, in either direction.
  const std::string hanging = replaced(
      dynamics_arm(), "[[arm", "base.rotation = [0.7071067811865476, 0.7071067811865476, 0, 0]\n[[arm");
  for (const char* azimuths : {"[180, 170, 160]", "[-180, -190, -200]", "[540, 550, 560]"})
    EXPECT_EQ(error(hanging, azimuths), "no error") << azimuths;
  EXPECT_THAT(error(hanging, "[0, 10, 20]"), HasSubstr("expected the value at the arm's clamped base"));
  for (const char* azimuths : {"[0, 170, 190]", "[360, 370, 380]", "[0, 180, 360]", "[0, -180, 0]"})
    EXPECT_EQ(error(dynamics_arm(), azimuths), "no error") << azimuths;
}

TEST(BadDynamics, TheArmHasToFitToo) {
  const std::string straight = "target.archings = [0, 0, 0]\n";
  EXPECT_THAT(error_of_file(dynamics_arm("planar") + dynamics_task(straight + "gravity = [0, -9, 1]\n")),
              HasSubstr("task[0].gravity: leaves the plane of a planar arm: expected 0 along Z"));
  EXPECT_THAT(error_of_file(dynamics_arm("planar") +
                            dynamics_task("target.azimuths = [0, 1]\ntarget.elevations = [0, 0.1]\n")),
              HasSubstr("task[0].target.elevations[1]: leaves the plane: expected 0 for a planar arm"));
  EXPECT_THAT(error_of_file(replaced(dynamics_arm(), "[[arm", "base.rotation = [1, 0, 0, 0]\n[[arm") +
                            dynamics_task(bent_target)),
              HasSubstr("task[0]: the arm's base points along Z: expected an elevation below 90 deg"));
  const auto error_of_many = [](int sections, const std::string& basis) {
    std::string many = "[arm]\n";
    for (int i = 0; i < sections; ++i) many += "[[arm.section]]\nlength = 0.1\n";
    return error_of_file(
        many +
        dynamics_task("target.azimuths = [0, 0]\ntarget.elevations = [0, 0]\nbasis = \"" + basis + "\"\n"));
  };
  EXPECT_THAT(
      error_of_many(41, "sections"),
      HasSubstr("task[0].basis: \"sections\" with 41 sections: expected at most 40, or \"polynomial\""));
  EXPECT_EQ(error_of_many(41, "polynomial"), "no error");
  EXPECT_THAT(error_of_many(201, "polynomial"),
              testing::EndsWith("task[0].basis: \"polynomial\" with 201 sections: expected at most 200"));
  EXPECT_THAT(error_of_many(201, "sections"),
              testing::EndsWith("task[0].basis: \"sections\" with 201 sections: expected at most 40"));
}

}  // namespace
}  // namespace flexura
