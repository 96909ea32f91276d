#include "flexura/app/jog_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/problems.h"
#include "flexura/kinematics/tendons.h"
#include "flexura/sim/arm_setup.h"
#include "tests/support/laboratory.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Experiment jog_lab(const std::string& section = "", const std::string& grbl = "") {
  std::string file = lab_file("/dev/ttyUSB0", 1, "visca.bus.link = \"udp:127.0.0.1:52381\"\n");
  file.insert(file.find("[drive]"), section);
  file.insert(file.find("[[rig.camera]]"), grbl);
  return parse_experiment(file, "lab.toml");
}

std::string problem_of_jog(const Experiment& lab, const std::string& name, const std::string& distance) {
  try {
    (void)jog_distance(jog_axis(lab, name), distance);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(JogAxis, HasAName) {
  const Experiment lab = jog_lab();
  EXPECT_THAT(jog_axis_names(lab),
              ElementsAre("motor.1", "motor.2", "motor.3", "tendon.1", "tendon.2", "tendon.3", "section.1.x",
                          "section.1.y", "front.pan", "front.tilt", "front.zoom"));
  for (const std::string& name : jog_axis_names(lab)) EXPECT_EQ(jog_axis(lab, name).name, name);
  EXPECT_EQ(jog_axis(lab, "motor.2").index, 1u);
  EXPECT_EQ(jog_axis(lab, "section.1.y").component, 1);
  for (const char* wrong :
       {"", "motor", "motor.0", "motor.4", "motor.1.x", "motor.one", "motor.-1", "section.1", "section.2.x",
        "section.1.z", "front.roll", "side.pan", ".pan", "motor.1 ", "Motor.1", "motor.99999999999999999999"})
    EXPECT_THAT(problem_of_jog(lab, wrong, "1"),
                HasSubstr(std::string("AXIS: \"") + wrong + "\": expected one of motor.1, "));
}

TEST(JogAxis, ReadsDistancesWithUnits) {
  const Experiment lab = jog_lab();
  const auto read = [&](const char* axis, const char* distance) {
    return jog_distance(jog_axis(lab, axis), distance);
  };
  EXPECT_EQ(read("motor.1", "200"), 200);
  EXPECT_EQ(read("motor.1", "-200 microsteps"), -200);
  EXPECT_DOUBLE_EQ(read("tendon.1", "+0.5mm"), 0.5e-3);
  EXPECT_DOUBLE_EQ(read("section.1.x", "-5deg"), -5 * degree);
  EXPECT_DOUBLE_EQ(read("front.pan", "2"), 2 * degree);
  EXPECT_DOUBLE_EQ(read("front.zoom", "0.25"), 0.25);
  for (const char* wrong : {"", "mm", "5 m", "5deg", "five", "5mm mm", "0x10", "1e999"})
    EXPECT_THAT(problem_of_jog(lab, "tendon.1", wrong), HasSubstr("expected a number of mm")) << wrong;
  for (const char* wrong : {"nan", "inf", "-inf"})
    EXPECT_THAT(problem_of_jog(lab, "tendon.1", wrong), HasSubstr("expected a finite number"));
  EXPECT_THAT(problem_of_jog(lab, "tendon.1", "0"), HasSubstr("other than 0"));
}

TEST(ArmJog, OfASectionMovesAllItsTendons) {
  const Experiment lab = jog_lab("max_bend_rate_deg = 4\n");
  std::vector<std::string> refusals;
  const ArmJog jog = plan_arm_jog(lab, jog_axis(lab, "section.1.x"), 10 * degree, refusals);
  EXPECT_THAT(refusals, IsEmpty());
  // Pulled by radius times bend times the cosine of the tendon's angle.
  ASSERT_THAT(jog.pulled, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(jog.pulled[i], 0.01 * 10 * degree * std::cos(120 * degree * static_cast<double>(i)), 1e-12);
  // The fastest moment of a move at rest at both ends is 1.875 times its mean rate.
  EXPECT_GE(jog.duration, 1.875 * 10 / 4) << "not faster than the section's limit";
}

TEST(ArmJog, IsRefusedIfItWouldHarm) {
  std::vector<std::string> refusals;
  const Experiment limited = jog_lab("max_bend_deg = 8\n");
  (void)plan_arm_jog(limited, jog_axis(limited, "section.1.x"), 10 * degree, refusals);
  EXPECT_THAT(refusals, ElementsAre("section 1: bend 10 deg, limit 8 deg"));

  // A third of what one of three tendons is pulled is against the others.
  refusals.clear();
  const Experiment lab = jog_lab();
  (void)plan_arm_jog(lab, jog_axis(lab, "tendon.2"), 2.9e-3, refusals);
  EXPECT_THAT(refusals, IsEmpty());
  (void)plan_arm_jog(lab, jog_axis(lab, "tendon.2"), 3.3e-3, refusals);
  ASSERT_THAT(refusals, SizeIs(3)) << "all three are as tight as each other";
  EXPECT_THAT(refusals[1], HasSubstr("tendon 2 would pull 1.1 mm against the others, limit 1 mm"));
  refusals.clear();
  (void)plan_arm_jog(lab, jog_axis(lab, "tendon.2"), -20e-3, refusals);
  EXPECT_THAT(refusals, IsEmpty()) << "a tendon that is let out becomes slack";

  const Experiment travelling = jog_lab("", "travel = 50\n");
  (void)plan_arm_jog(travelling, jog_axis(travelling, "motor.1"), 50, refusals);
  EXPECT_THAT(refusals, IsEmpty());
  (void)plan_arm_jog(travelling, jog_axis(travelling, "motor.1"), -51, refusals);
  EXPECT_THAT(refusals,
              ElementsAre(HasSubstr("motor 1 would go to -51 microsteps, its controller's limits")));
}

}  // namespace
}  // namespace flexura
