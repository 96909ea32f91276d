#include "flexura/port/driven_arm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/kinematics/tendons.h"
#include "flexura/model/drive_config.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// A controller that reaches its targets at once.
class SentDrive : public DrivePort {
 public:
  DriveQuantity takes = DriveQuantity::motor_positions;
  std::vector<double> at = std::vector<double>(3, 0), carried;
  double lasts = -1;
  std::optional<PortFault> fault;
  std::size_t count = 3;

  [[nodiscard]] DriveQuantity quantity() const override { return takes; }
  [[nodiscard]] std::size_t axes() const override { return count; }
  CommandOutcome command(std::span<const double> targets, double duration) override {
    if (fault) return *fault;
    at.assign(targets.begin(), targets.end()), lasts = duration;
    return Accepted{};
  }
  CommandOutcome halt() override {
    if (fault) return *fault;
    return Accepted{};
  }
  Outcome<DriveReading> read() override {
    if (fault) return *fault;
    return DriveReading{7, at, carried, true};
  }
};

Arm one_section() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.resize(1);
  arm.sections[0].length = 0.3;
  return arm;
}

Drive three_tendons(double backlash = 0) {
  DriveConfig config;
  config.spool.backlash = backlash;
  for (int i = 0; i < 3; ++i) {
    TendonConfig& tendon = config.tendon.emplace_back();
    tendon.angle = 2 * std::numbers::pi * i / 3;
    tendon.reversed = i == 1;
  }
  return config.drive();
}

ArmState bent(double x, double y) { return {{{x, y}}, {1}}; }

double off(DrivenArm& arm, const ArmState& desired) {
  return (arm.read().value().state.bends[0] - desired.bends[0]).norm();
}

// Bend that half a microstep of each tendon makes, rad.
double half_step(const Drive& drive) {
  return 2 * 0.5 / (drive.axes[0].microsteps_a_metre() * drive.tendons[0].radius);
}

TEST(DrivenArm, PullsEachTendonWhateverShapeThatMakes) {
  const double backlash = 0.05;
  SentDrive drive;
  DrivenArm arm(drive, one_section(), three_tendons(backlash), ArmState::straight(1));
  const std::vector<double> desired = {0.004, 0.001, -0.002};
  ASSERT_TRUE(arm.pull(desired, 2));
  EXPECT_EQ(drive.lasts, 2);
  const Drive nominal = three_tendons(backlash);
  for (std::size_t i = 0; i < 3; ++i) {
    const double sense = nominal.axes[i].reversed ? -1 : 1;
    // A motor that pays out turns further by the backlash.
    const double motor =
        desired[i] * nominal.axes[i].microsteps_a_metre() - (i == 2 ? nominal.axes[i].backlash_steps() : 0);
    EXPECT_NEAR(sense * drive.at[i], motor, 1) << i;
  }
  const std::vector<double> before = drive.at;
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(arm.pull({0, 0}, 1));
  EXPECT_FALSE(arm.pull({0, 0, none}, 1));
  EXPECT_FALSE(arm.pull({0, 0, 1e30}, 1));
  EXPECT_EQ(drive.at, before);
}

TEST(DrivenArm, MakesMicrostepsOfShapesAndShapesOfMicrosteps) {
  const Drive drive = three_tendons();
  for_random_cases(30, [&](TestRandom& random) {
    SentDrive port;
    DrivenArm arm(port, one_section(), drive, ArmState::straight(1));
    EXPECT_EQ(arm.read().value().positions, std::vector<std::int64_t>(3, 0));
    const ArmState desired = bent(random.uniform(-1, 1), random.uniform(-1, 1));
    ASSERT_TRUE(arm.command(desired, 0.25));
    EXPECT_EQ(port.lasts, 0.25);
    const auto exact = motor_positions(drive, tendon_displacements(one_section(), drive, desired));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(port.at[i], std::round(exact[i]));
    const ArmReading reading = arm.read().value();
    EXPECT_LE(off(arm, desired), half_step(drive));
    EXPECT_EQ(reading.positions[1], std::llround(exact[1]));
    EXPECT_EQ(reading.time, 7);
    EXPECT_TRUE(reading.moving);
  });
}

TEST(DrivenArm, SendsADriveOfDisplacementsWhatItsTendonsNeed) {
  const Drive drive = three_tendons(0.1);  // Here the controller compensates the backlash.
  SentDrive port;
  port.takes = DriveQuantity::tendon_displacements;
  DrivenArm arm(port, one_section(), drive, ArmState::straight(1));
  for (const ArmState& desired : {bent(0.4, -0.3), bent(-0.2, 0.1)}) {
    ASSERT_TRUE(arm.command(desired, 0));
    EXPECT_EQ(port.at, tendon_displacements(one_section(), drive, desired).pulled);
    EXPECT_LE(off(arm, desired), 1e-12);
    EXPECT_TRUE(arm.read().value().positions.empty());
  }
}

TEST(DrivenArm, TellsADriveOfTensionsThatStaticsAreMissing) {
  SentDrive port;
  port.takes = DriveQuantity::tendon_tensions;
  try {
    DrivenArm(port, one_section(), three_tendons(), ArmState::straight(1));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("a drive with tension targets cannot move this arm"));
  }
}

TEST(DrivenArm, RefusesAControllerOfOtherAxes) {
  SentDrive port;
  port.count = 4;
  EXPECT_THROW(DrivenArm(port, one_section(), three_tendons(), ArmState::straight(1)), std::invalid_argument);
}

// The motors move through the backlash at reversals, and the readings give the tendons' positions.
TEST(DrivenArm, TakesUpThePlayAndFollowsItInWhatIsRead) {
  const Drive drive = three_tendons(0.1);
  ASSERT_GT(drive.axes[0].backlash_steps(), 40);
  for_random_cases(30, [&](TestRandom& random) {
    SentDrive port;
    DrivenArm arm(port, one_section(), drive, ArmState::straight(1));
    for (int i = 0; i < 8; ++i) {
      const ArmState desired = bent(random.uniform(-1, 1), random.uniform(-1, 1));
      ASSERT_TRUE(arm.command(desired, 0));
      EXPECT_LE(off(arm, desired), half_step(drive));
    }
  });
}

Drive rubbing_tendons(double backlash, double travel) {
  Drive drive = three_tendons(backlash);
  for (Axis& axis : drive.axes) axis.spool.friction_travel = travel;
  return drive;
}

// The motors also move through the travel that friction takes, and the readings give the shape.
TEST(DrivenArm, TakesUpTheTravelThatFrictionTakesAndReadsTheShape) {
  const Drive drive = rubbing_tendons(0.1, 0.002);
  const double microsteps = drive.axes[0].microsteps_a_metre();
  ASSERT_GT(0.002 * microsteps, 40);
  for_random_cases(30, [&](TestRandom& random) {
    SentDrive port;
    const ArmState initial = bent(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    DrivenArm arm(port, one_section(), drive, initial);
    const auto start = nominal_positions(one_section(), drive, initial);
    port.at.assign(start.begin(), start.end());
    EXPECT_LE(off(arm, initial), half_step(drive));
    std::vector<double> tendons = tendon_displacements(one_section(), drive, initial).pulled, spools;
    for (const double tendon : tendons)
      spools.push_back(tendon * microsteps + 0.001 * initial.bends[0].norm() * microsteps);
    for (int i = 0; i < 8; ++i) {
      const ArmState desired = bent(random.uniform(-1, 1), random.uniform(-1, 1));
      ASSERT_TRUE(arm.command(desired, 0));
      EXPECT_LE(off(arm, desired), 1.2 * half_step(drive));
      const std::vector<double> now = tendon_displacements(one_section(), drive, desired).pulled;
      const double half = 0.001 * desired.bends[0].norm() * microsteps;
      for (std::size_t k = 0; k < 3; ++k) {
        // The spool may turn the other way than its tendon moves, because the tendon's wrap changes.
        const double spool = now[k] * microsteps + (now[k] < tendons[k] ? -half : half),
                     backlash = spool < spools[k] ? drive.axes[k].backlash_steps() : 0;
        EXPECT_NEAR((k == 1 ? -1 : 1) * port.at[k], spool - backlash, 0.51) << i << ", tendon " << k;
        spools[k] = spool;
      }
      tendons = now;
    }
  });
}

// A controller that reports load positions knows its backlash, but not the friction behind it.
TEST(DrivenArm, ReadsTheShapeBehindFrictionFromLoadPositionsToo) {
  const Drive drive = rubbing_tendons(0, 0.002);
  SentDrive port;
  DrivenArm arm(port, one_section(), drive, ArmState::straight(1));
  for (const ArmState& desired : {bent(0.4, -0.3), bent(0.3, -0.2), bent(0.6, 0.1)}) {
    ASSERT_TRUE(arm.command(desired, 0));
    port.carried = port.at;
    EXPECT_LE(off(arm, desired), 1.2 * half_step(drive));
    // A read changes nothing.
    EXPECT_LE(off(arm, desired), 1.2 * half_step(drive));
  }
}

TEST(DrivenArm, PullsTendonsThroughTheFrictionOfTheNearestShape) {
  const Drive drive = rubbing_tendons(0, 0.002);
  SentDrive port, other;
  DrivenArm arm(port, one_section(), drive, ArmState::straight(1)),
      same(other, one_section(), drive, ArmState::straight(1));
  ASSERT_TRUE(arm.command(bent(0.4, -0.3), 0));
  ASSERT_TRUE(same.pull(tendon_displacements(one_section(), drive, bent(0.4, -0.3)).pulled, 0));
  EXPECT_EQ(port.at, other.at);
}

TEST(DrivenArm, BelievesADriveThatFollowsItsPlay) {
  const Drive drive = three_tendons(0.1);
  SentDrive port;
  DrivenArm arm(port, one_section(), drive, ArmState::straight(1));
  port.carried = motor_positions(drive, tendon_displacements(one_section(), drive, bent(0.2, 0.3)));
  EXPECT_LE(off(arm, bent(0.2, 0.3)), 1e-12);
  EXPECT_EQ(arm.read().value().positions, std::vector<std::int64_t>(3, 0));
}

// A command that fails must not change the backlash state: repeated, it gives the same positions.
TEST(DrivenArm, ACommandThatWasNotTakenLeavesNothingBehind) {
  const Drive drive = three_tendons(0.1);
  SentDrive port, other;
  DrivenArm arm(port, one_section(), drive, ArmState::straight(1));
  DrivenArm undisturbed(other, one_section(), drive, ArmState::straight(1));
  port.fault = PortFault{FaultKind::link_lost, "gone"};
  EXPECT_EQ(arm.command(bent(0.5, 0), 0).fault()->what, "gone");
  EXPECT_EQ(arm.halt().fault()->what, "gone");
  EXPECT_EQ(arm.read().fault()->what, "gone");
  port.fault.reset();
  for (DrivenArm* one : {&arm, &undisturbed}) {
    ASSERT_TRUE(one->command(bent(0.001, 0), 0));
    ASSERT_TRUE(one->halt());
  }
  EXPECT_EQ(port.at, other.at);
}

TEST(DrivenArm, RefusesWhatIsNoCommandAndSendsNothing) {
  SentDrive port;
  DrivenArm arm(port, one_section(), three_tendons(), ArmState::straight(1));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [state, duration] : {std::pair{bent(nan, 0), 0.0},
                                        {ArmState::straight(2), 0.0},
                                        {bent(0.1, 0), -1.0},
                                        {bent(0.1, 0), nan},
                                        {bent(1e15, 0), 0.0}}) {
    const auto fault = arm.command(state, duration).fault();
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->kind, FaultKind::refused);
    EXPECT_THAT(fault->what, HasSubstr("the arm: "));
  }
  EXPECT_EQ(port.lasts, -1);
}

TEST(DrivenArm, OfAControllerThatTellsNonsenseNothingIsBelieved) {
  SentDrive port;
  DrivenArm arm(port, one_section(), three_tendons(), ArmState::straight(1));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, 1e19}) {
    port.at[2] = bad;
    EXPECT_THAT(arm.read().fault()->what, HasSubstr("positions that are not finite"));
  }
  port.at.pop_back();
  EXPECT_THAT(arm.read().fault()->what, HasSubstr("reports 2 motor positions"));
}

}  // namespace
}  // namespace flexura
