// Invalid materials, tendons and loads of an arm: each must give clear lines with the place, the error and
// the expectation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/experiment_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr const char* good_rods = R"([arm]
kind = "spatial"
model = "static"
gravity = [0, -9.81, 0]
[[arm.section]]
length = 0.3
radius = 0.02
[arm.section.material]
youngs_modulus = 54e9
poisson = 0.3
density = 6450
radius_mm = 0.7
rest_bend_deg = [10, 0]
modes = { bend = 6 }
[[arm.section.material.mass]]
at = 0.5
mass = 0.01
[[arm.section]]
length = 0.2
radius = [0.02, 0.01]
[arm.section.material]
stiffness = { shear = 1e4, stretch = 1e4, bend = [0.01, 0.02], twist = 0.01 }
mass_per_length = 0.1
[[arm.tendon]]
section = 2
radius = 0.01
angle_deg = 30
turns = 0.5
[[arm.load]]
section = 2
force = [1, 0, 0]
)";

// Returns the good file with the first `from` replaced.
std::string rods_with(const std::string& from, const std::string& to) {
  return replaced(good_rods, from, to);
}

TEST(BadMaterialFiles, TheGoodOneIsGood) { EXPECT_EQ(error_of_file(good_rods), "no error"); }

TEST(BadMaterialFiles, EachGetsALineWithPlaceValueAndExpectation) {
  const std::string first = "[arm.section.material]\nyoungs_modulus = 54e9\n";
  const std::vector<BadFile> files{
      {"no stiffness", rods_with("youngs_modulus = 54e9", "youngs_modulus = 0"),
       "x.toml:9:18: arm.section[0].material.youngs_modulus = 0: expected a number above 0"},
      {"negative stiffness", rods_with("youngs_modulus = 54e9", "youngs_modulus = -54e9"),
       "arm.section[0].material.youngs_modulus = -54000000000: expected a number above 0"},
      {"infinite stiffness", rods_with("youngs_modulus = 54e9", "youngs_modulus = inf"),
       "arm.section[0].material.youngs_modulus = inf: expected a number above 0"},
      {"stiffness that is no number", rods_with("youngs_modulus = 54e9", "youngs_modulus = nan"),
       "arm.section[0].material.youngs_modulus = nan: expected a number above 0"},
      {"nothing elastic", rods_with("youngs_modulus = 54e9\n", ""),
       "x.toml:8:14: arm.section[0].material: has no stiffness: expected youngs_modulus, or stiffness"},
      {"Poisson's ratio above a half", rods_with("poisson = 0.3", "poisson = 0.6"),
       "x.toml:10:11: arm.section[0].material.poisson = 0.6: expected a number from 0 to 0.5"},
      {"both moduli and Poisson's ratio", rods_with("poisson = 0.3", "poisson = 0.3\nshear_modulus = 2e10"),
       "x.toml:10:1: arm.section[0].material.poisson: is given together with shear_modulus: expected one "
       "of them"},
      {"modulus and stiffness", rods_with("mass_per_length = 0.1", "youngs_modulus = 1e9"),
       "x.toml:23:1: arm.section[1].material.youngs_modulus: is given together with stiffness: expected "
       "one of them"},
      {"stiffness 0", rods_with("twist = 0.01", "twist = 0"),
       "arm.section[1].material.stiffness.twist = 0: expected a number above 0"},
      {"stiffness left out", rods_with(", twist = 0.01", ""),
       "arm.section[1].material.stiffness.twist: missing: expected a number"},
      {"negative bend stiffness", rods_with("[0.01, 0.02]", "[0.01, -0.02]"),
       "arm.section[1].material.stiffness.bend[1] = -0.02: expected a number above 0"},
      {"density beside mass", rods_with("mass_per_length = 0.1", "mass_per_length = 0.1\ndensity = 1"),
       "arm.section[1].material.mass_per_length: is given together with density: expected one of them"},
      {"a bore as wide as the rod", rods_with("radius_mm = 0.7", "radius_mm = 0.7\ninner_radius_mm = 0.7"),
       "x.toml:13:1: arm.section[0].material.inner_radius: 0.0007 m in a rod of radius 0.0007 m: expected a "
       "smaller radius"},
      {"a bore as wide as the tube", rods_with("radius_mm = 0.7", "inner_radius = [0, 0.02]"),
       "arm.section[0].material.inner_radius: 0.02 m in a rod of radius 0.02 m: expected a smaller radius"},
      {"modes", rods_with("bend = 6", "bend = 21"),
       "arm.section[0].material.modes.bend = 21: expected a whole number from 0 to 20"},
      {"one node", rods_with("density = 6450", "nodes = 1"),
       "x.toml:11:1: arm.section[0].material.nodes: 1: expected at least 7, or 0"},
      {"a mass beyond the section", rods_with("at = 0.5", "at = 1.5"),
       "x.toml:16:6: arm.section[0].material.mass[0].at = 1.5: expected a number from 0 to 1"},
      {"no mass", rods_with("mass = 0.01\n", ""), "arm.section[0].material.mass[0].mass: missing"},
      {"no disks", rods_with("density = 6450", "disks = 0"),
       "arm.section[0].material.disks = 0: expected a whole number from 1 to 1000"},
      {"another model", rods_with("\"static\"", "\"statics\""),
       "x.toml:3:9: arm.model = \"statics\": expected one of \"kinematic\", \"static\", \"dynamic\"; did you "
       "mean "
       "\"static\"?"},
      {"gravity that is no number", rods_with("-9.81", "nan"), "x.toml:4:15: arm.gravity[1] = nan: expected"},
      {"a section without a material",
       rods_with(
           "[arm.section.material]\nstiffness = { shear = 1e4, stretch = 1e4, bend = [0.01, 0.02], twist "
           "= 0.01 }\nmass_per_length = 0.1\n",
           ""),
       "x.toml:18:1: arm.section[1]: has no material: expected material.youngs_modulus or "
       "material.stiffness, because the arm's model is \"static\""},
      {"a tendon outside the tube", rods_with("radius = 0.01\n", "radius = 0.011\n"),
       "arm.tendon[0]: leaves the tube: expected at most 0.0108 m from the backbone in section 2, 0.484 "
       "m "
       "from the base, not 0.011 m"},
      {"a tendon that spreads out of it", rods_with("turns = 0.5", "end_radius = 0.03"),
       "arm.tendon[0]: leaves the tube: expected at most 0.02 m"},
      {"a polynomial out of it", rods_with("turns = 0.5", "x = [0, 0, 1]"), "arm.tendon[0]: leaves the tube"},
      {"a polynomial past all bounds", rods_with("turns = 0.5", "x = [1e9, -1e9, 1e9]"), "leaves the tube"},
      {"a tendon beyond the arm", rods_with("[[arm.tendon]]\nsection = 2", "[[arm.tendon]]\nsection = 3"),
       "x.toml:25:1: arm.tendon[0].section: 3: expected a section of the arm, 1 to 2"},
      {"tendon 0", rods_with("[[arm.tendon]]\nsection = 2", "[[arm.tendon]]\nsection = 0"),
       "x.toml:25:11: arm.tendon[0].section = 0: expected a whole number from 1 to"},
      {"a negative radius", rods_with("radius = 0.01\n", "radius = -0.01\n"),
       "arm.tendon[0].radius = -0.01: expected a number from 0"},
      {"a negative compliance", rods_with("turns = 0.5", "compliance = -1"),
       "arm.tendon[0].compliance = -1: expected a number from 0"},
      {"a load beyond the arm", rods_with("[[arm.load]]\nsection = 2", "[[arm.load]]\nsection = 9"),
       "arm.load[0].section: 9: expected a section of the arm, 1 to 2"},
      {"an infinite load", rods_with("force = [1, 0, 0]", "force = [1, inf, 0]"),
       "x.toml:31:13: arm.load[0].force[1] = inf: expected a number from"},
      {"a load that is no number", rods_with("force = [1, 0, 0]", "moment = [nan, 0, 0]"),
       "arm.load[0].moment[0] = nan: expected a number from"},
  };
  for (const BadFile& file : files) EXPECT_THAT(error_of_file(file.text), HasSubstr(file.error)) << file.what;
}

TEST(MaterialFiles, ATruthSaysTheSameInAnotherWay) {
  const std::string truth = R"([[truth.arm.section]]
material = { stiffness = { shear = 1e4, stretch = 1e4, bend = 0.01, twist = 0.01 }, mass_per_length = 0.2 }
[[truth.arm.section]]
material = { stiffness = { bend = [0.02, 0.03] } }
[[truth.arm.tendon]]
angle_deg = 31
)";
  const Experiment experiment = parse_experiment(good_rods + truth, "x.toml");
  ASSERT_TRUE(experiment.truth && experiment.truth->arm);
  const ArmConfig& arm = *experiment.truth->arm;
  ASSERT_EQ(arm.section.size(), 2U);
  const MaterialConfig& first = *arm.section[0].material;
  EXPECT_FALSE(first.youngs_modulus || first.poisson);
  EXPECT_EQ(first.stiffness->bend, (std::array{0.01, 0.01}));
  EXPECT_EQ(first.mass_per_length, 0.2);
  EXPECT_EQ(first.density, 0);
  EXPECT_EQ(first.radius, (std::array{0.7e-3, 0.7e-3}));
  ASSERT_EQ(first.mass.size(), 1U);
  EXPECT_EQ(arm.section[1].material->stiffness->bend, (std::array{0.02, 0.03}));
  EXPECT_EQ(arm.section[1].material->stiffness->shear, (std::array{1e4, 1e4}));
  EXPECT_EQ(arm.tendon[0].turns, 0.5);
  EXPECT_EQ(arm.mechanics, ArmMechanics::statics);
  const std::string written = experiment_toml(experiment);
  EXPECT_EQ(experiment_toml(parse_experiment(written, "written.toml")), written);
}

}  // namespace
}  // namespace flexura
