// Invalid tables [drive]: each must give clear lines with the place, the error and the expectation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/experiment_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr const char* good_drive = R"([arm]
kind = "spatial"
[[arm.section]]
length = 0.3
[[arm.section]]
length = 0.2
[drive]
radius_mm = 15
[drive.motor]
steps = 600
[drive.spool]
gear = 10
[[drive.tendon]]
section = 1
angle_deg = 0
[[drive.tendon]]
section = 1
angle_deg = 120
[[drive.tendon]]
section = 2
angle_deg = 60
[[drive.tendon]]
section = 2
angle_deg = 150
)";

// Returns the good file with the first `from` replaced.
std::string drive_with(const std::string& from, const std::string& to) {
  return replaced(good_drive, from, to);
}

TEST(BadDriveFiles, TheGoodOneIsGood) { EXPECT_EQ(error_of_file(good_drive), "no error"); }

TEST(BadDriveFiles, EachGetsALineWithPlaceValueAndExpectation) {
  const std::vector<BadFile> files{
      {"no tendons", "[[arm.section]]\nlength = 1\n[drive]\n",
       "x.toml:3:2: drive.tendon: missing: expected an array (Tendons in the order"},
      {"no section", drive_with("section = 1\n", ""),
       "x.toml:13:1: drive.tendon[0].section: missing: expected"},
      {"no angle", drive_with("angle_deg = 0\n", ""),
       "x.toml:13:1: drive.tendon[0].angle: missing: expected"},
      {"section 0", drive_with("section = 1", "section = 0"),
       "x.toml:14:11: drive.tendon[0].section = 0: expected a whole number from 1 to"},
      {"a section beyond the arm", drive_with("section = 2", "section = 3"),
       "x.toml:20:1: drive.tendon[2].section: 3: expected a section of the arm, 1 to 2"},
      {"half a section", drive_with("section = 2", "section = 1.5"),
       "drive.tendon[2].section = 1.5: expected a whole number from 1 to"},
      {"angle in mm", drive_with("angle_deg", "angle_mm"),
       "drive.tendon[0].angle_mm: wrong unit: expected angle"},
      {"no radius", drive_with("radius_mm = 15", "radius_mm = 0"),
       "x.toml:8:13: drive.radius_mm = 0: expected a number above 0 mm"},
      {"a tendon on the backbone", drive_with("angle_deg = 0", "angle_deg = 0\nradius = -1"),
       "x.toml:16:10: drive.tendon[0].radius = -1: expected a number above 0 m"},
      {"too few tendons", drive_with("[[drive.tendon]]\nsection = 2\nangle_deg = 60\n", ""),
       "drive.tendon: does not determine the bend of section 2, where 1 tendon ends: expected at least 2 in "
       "different directions"},
      {"tendons of another section", drive_with("section = 1", "section = 2"),
       "drive.tendon: does not determine the bend of section 1, where 1 tendon ends: expected at least 2"},
      {"tendons in one direction", drive_with("angle_deg = 120", "angle_deg = 180"),
       "drive.tendon: does not determine the bend of section 1, where 2 tendons end: expected at least 2 in "
       "different directions"},
      {"a stretch that two tendons do not determine",
       drive_with("length = 0.3", "length = 0.3\nstretch_limits = [0.9, 1.1]"),
       "drive.tendon: does not determine the bend and the stretch of section 1, where 2 tendons end: "
       "expected at least 3 that are not on one line"},
      {"a planar tendon out of the plane",
       "arm.section = [{length = 1}]\ndrive.tendon = [{section = 1, angle_deg = 90}]\n",
       "does not determine the bend of section 1, where 1 tendon ends: expected at least 1 that is not at "
       "90"},
      {"a planar stretch with tendons on one side",
       "arm.section = [{length = 1, stretch_limits = [0.5, 2]}]\n"
       "drive.tendon = [{section = 1, angle = 0}, {section = 1, angle = 0}]\n",
       "expected at least 2 on different sides of the arm"},
      {"steps that are no multiple of the phases", drive_with("steps = 600", "steps = 200"),
       "x.toml:10:1: drive.motor.steps: 200 full steps per revolution of a motor with 3 phases: expected a "
       "multiple "
       "of the phases"},
      {"one phase", drive_with("steps = 600", "phases = 1"),
       "drive.motor.phases = 1: expected a whole number from 2"},
      {"no microsteps", drive_with("steps = 600", "microsteps = 0"),
       "drive.motor.microsteps = 0: expected a whole number from 1"},
      {"no speed", drive_with("steps = 600", "max_speed = 0"),
       "drive.motor.max_speed = 0: expected a number above 0 rad/s"},
      {"acceleration in the wrong unit", drive_with("steps = 600", "max_acceleration_mm = 1"),
       "drive.motor.max_acceleration_mm: wrong unit: expected max_acceleration (rad/s^2), "},
      {"no gear", drive_with("gear = 10", "gear = 0"), "drive.spool.gear = 0: expected a number above 0"},
      {"negative play", drive_with("gear = 10", "backlash_deg = -1"),
       "x.toml:12:16: drive.spool.backlash_deg = -1: expected a number from 0 deg"},
      {"negative lost travel", drive_with("gear = 10", "friction_travel_mm = -1"),
       "x.toml:12:22: drive.spool.friction_travel_mm = -1: expected a number from 0 mm"},
      {"lost travel beyond reason", drive_with("gear = 10", "friction_travel_mm = 8"),
       "drive.tendon[0]: loses a travel of 0.008 m per radian by friction (spool.friction_travel): expected "
       "at "
       "most half of its radius, 0.0075 m"},
      {"misspelt table", drive_with("[drive.spool]", "[drive.spools]"),
       "x.toml:11:8: drive.spools: unknown key; did you mean \"spool\"?"},
      {"no controller", drive_with("radius_mm = 15", "axes_per_controller = 0"),
       "drive.axes_per_controller = 0: expected a whole number from 1"},
      {"no piece between disks", drive_with("radius_mm = 15", "disks = 0"),
       "drive.disks = 0: expected a whole number from 1"},
      {"a motor of its own that does not fit", drive_with("angle_deg = 0", "angle_deg = 0\nmotor.phases = 7"),
       "drive.tendon[0].motor.steps: 300 full steps per revolution of a motor with 7 phases"},
      {"positions beyond what is counted exactly", drive_with("gear = 10", "gear = 1e6\nradius = 1e-9"),
       "drive.tendon[0]: needs up to "},
  };
  for (const BadFile& file : files) EXPECT_THAT(error_of_file(file.text), HasSubstr(file.error)) << file.what;
}

TEST(BadDriveFiles, LeaveGoodOnesAlone) {
  for (const std::string& text :
       {drive_with("spatial", "planar"),
        drive_with("angle_deg = 0", "angle_deg = 0\nreversed = true\nradius_mm = 90"),
        drive_with("radius_mm = 15", "disks = 1\naxes_per_controller = 1"),
        drive_with("steps = 600", "phases = 5\nsteps = 500\nmicrosteps = 1\nmax_step_rate = 1e5"),
        std::string("arm.section = [{length = 1, stretch_limits = [0.5, 2]}]\n"
                    "drive.tendon = [{section = 1, angle = 0}, {section = 1, angle_pi = 1}]\n")}) {
    EXPECT_EQ(error_of_file(text), "no error") << text;
  }
}

TEST(DriveFiles, SayWhichAxisPullsWhichTendon) {
  const Drive drive = parse_experiment(drive_with("angle_deg = 120",
                                                  "angle_deg = 120\nradius_mm = 20\nreversed = true\n"
                                                  "spool = { radius = 0.03 }\nmotor = { steps = 300 }"),
                                       "x.toml")
                          .drive->drive();
  ASSERT_EQ(drive.tendons.size(), 4U);
  EXPECT_EQ(drive.tendons[1].section, 0U);
  EXPECT_EQ(drive.tendons[2].section, 1U);
  EXPECT_DOUBLE_EQ(drive.tendons[0].radius, 0.015);
  EXPECT_DOUBLE_EQ(drive.tendons[1].radius, 0.02);
  EXPECT_TRUE(drive.axes[1].reversed);
  EXPECT_EQ(drive.axes[0].motor.steps, 600);
  EXPECT_EQ(drive.axes[1].motor.steps, 300);
  EXPECT_DOUBLE_EQ(drive.axes[0].spool.gear, 10);
  EXPECT_DOUBLE_EQ(drive.axes[1].spool.gear, 1) << "a spool of its own is described whole";
  EXPECT_DOUBLE_EQ(drive.axes[1].spool.radius, 0.03);
}

}  // namespace
}  // namespace flexura
