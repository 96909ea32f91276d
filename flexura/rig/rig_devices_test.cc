// The way from shapes to motors, with the drivers of controllers, in simulated time.
#include "flexura/rig/rig_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "flexura/equipment/dry_devices.h"
#include "flexura/kinematics/tendons.h"
#include "tests/support/grbl_bench.h"

namespace flexura {
namespace {

// A simulated Grbl controller, and spools that its motors turn with a play.
class SteppedDevices : public DeviceAccess {
 public:
  explicit SteppedDevices(GrblDeviceConfig board, double play) : device_(std::move(board)), play_(play) {}
  [[nodiscard]] SteppedClock& clock() override { return clock_; }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const GrblConfig& /*config*/) override {
    auto link = std::make_unique<SteppedLink>(device_, clock_);
    link_ = link.get();
    link_->on_tick = [this](double now) {
      const std::vector<double> motors = device_.positions(now);
      // The backlash is taken up for pulling in at first.
      if (spools_.empty()) spools_ = motors;
      for (std::size_t i = 0; i < motors.size(); ++i) {
        spools_[i] = std::clamp(spools_[i], motors[i], motors[i] + play_);
      }
    };
    return std::unique_ptr<Link>(std::move(link));
  }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const Cia402Config& /*config*/) override {
    return PortFault{FaultKind::link_lost, "no bus"};
  }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const ViscaBusConfig& /*config*/) override {
    return PortFault{FaultKind::link_lost, "no heads"};
  }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const OnvifConfig& /*config*/) override {
    return PortFault{FaultKind::link_lost, "no heads"};
  }
  [[nodiscard]] std::shared_ptr<V4l2Calls> calls(const V4l2HeadConfig& /*config*/) override {
    return nullptr;
  }
  [[nodiscard]] Guard* guard() override { return nullptr; }

  // Lets the controller finish.
  void pass(double duration) { link_->pass(duration); }
  [[nodiscard]] const std::vector<double>& spools() const { return spools_; }
  [[nodiscard]] std::vector<double> motors() { return device_.positions(clock_.now()); }

 private:
  SteppedClock clock_;
  GrblDevice device_;
  SteppedLink* link_ = nullptr;
  double play_;
  std::vector<double> spools_;
};

GrblDeviceConfig fast_board() {
  return {.settings = {{100, 100},
                       {101, 100},
                       {102, 100},
                       {110, 6000},
                       {111, 6000},
                       {112, 6000},
                       {120, 2000},
                       {121, 2000},
                       {122, 2000}}};
}

// An arm of one section with three tendons.
RigConfig three_tendons(double backlash) {
  RigConfig rig;
  rig.arm.kind = ArmKind::spatial;
  Section section;
  section.length = 0.3;
  rig.arm.section = {section};
  rig.drive.emplace();
  rig.drive->radius = 0.01;
  rig.drive->spool.backlash = backlash;
  for (const double angle : {0.0, 2 * M_PI / 3, 4 * M_PI / 3}) {
    TendonConfig tendon;
    tendon.angle = angle;
    rig.drive->tendon.push_back(tendon);
  }
  return rig;
}

// Returns the largest error of a tendon, microsteps, after motions with reversals, for an arm whose model has
// `modelled` and whose drive has `real` backlash, microsteps.
double largest_error(double modelled, double real) {
  const RigConfig exact = three_tendons(0);
  const double steps_per_radian =
      exact.drive->drive().axes[0].motor.resolution() * exact.drive->drive().axes[0].spool.gear / (2 * M_PI);
  const ArmSetup setup(three_tendons(modelled / steps_per_radian));
  RigEquipment equipment;
  equipment.grbl.resize(1);
  SteppedDevices devices(fast_board(), real);
  ArmEquipment arm(equipment, setup, devices);
  arm.start();
  double worst = 0;
  for (const auto& bend : {Eigen::Vector2d(0.5, 0.2), Eigen::Vector2d(0.1, 0.4), Eigen::Vector2d(-0.3, 0.1),
                           Eigen::Vector2d(0.2, -0.2)}) {
    ArmState shape = setup.initial;
    shape.bends[0] = bend;
    EXPECT_TRUE(arm.arm().command(shape, 0.5));
    devices.pass(3);
    const auto reading = arm.arm().read();
    EXPECT_TRUE(reading) << text(*reading.fault());
    const std::vector<double> exact_positions =
        motor_positions(*setup.drive, tendon_displacements(setup.arm, *setup.drive, shape));
    for (std::size_t i = 0; i < exact_positions.size(); ++i)
      worst = std::max(worst, std::abs(devices.spools()[i] - exact_positions[i]));
  }
  return worst;
}

TEST(ArmEquipment, CompensatesTheBacklashOfTheFile) {
  EXPECT_LE(largest_error(0, 0), 0.5 + 1e-6) << "without backlash, only the rounding to microsteps is left";
  EXPECT_LE(largest_error(20, 20), 1.0 + 1e-6) << "the spool ends within a microstep of the shape";
  const double uncompensated = largest_error(0, 20);
  EXPECT_GE(uncompensated, 19) << "without it, tendons that are let out miss by the backlash";
  EXPECT_LE(uncompensated, 21);
}

TEST(ArmEquipment, PullsTendonsInSlowlyAfterHoming) {
  GrblDeviceConfig board = fast_board();
  board.settings[22] = 1, board.settings[24] = 600, board.settings[25] = 3000;
  board.low = {-9000, -9000, -9000}, board.high = {4000, 9000, 9000};
  const RigConfig config = three_tendons(0.01);
  const ArmSetup setup(config);
  RigEquipment equipment;
  equipment.grbl.resize(1);
  equipment.start = StartPositions::pretensioned;
  equipment.pretension_speed = 0.001;
  // The switches are where the first tendon is slack and the second one is too tight.
  equipment.home = {-400, 300, -200};
  SteppedDevices devices(board, 0);
  ArmEquipment arm(equipment, setup, devices);
  const std::vector<double> at_rest = devices.motors();
  arm.start();
  const auto reading = arm.arm().read();
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading.value().positions, (std::vector<std::int64_t>{0, 0, 0}));
  EXPECT_EQ(reading.value().state, setup.initial);
  // The motors have turned by the distance from the switches: home is at another place of the controller.
  ArmState bent = setup.initial;
  bent.bends[0] = {0.01, 0};
  ASSERT_TRUE(arm.arm().command(bent, 1));
  devices.pass(3);
  EXPECT_NE(devices.motors(), at_rest);
}

TEST(ArmEquipment, ChecksTheDeclaredPositionsOfCanDrives) {
  const ArmSetup setup(three_tendons(0));
  RigEquipment equipment;
  equipment.cia402.emplace();
  for (int node = 1; node <= 3; ++node) equipment.cia402->axes.emplace_back().node = node;
  const auto start_at = [&](const std::vector<double>& motors) {
    DryDevices devices(equipment, motors, {}, [](const DryMessage& /*message*/) {});
    ArmEquipment arm(equipment, setup, devices);
    arm.start();
    return arm.drive().read().value().values;
  };
  std::vector<double> motors = start_at({0, 0, 0});
  EXPECT_EQ(motors, (std::vector<double>{0, 0, 0}));
  try {
    (void)start_at({0, 12345, 0});
    FAIL() << "the first command would move the second motor by 12345 microsteps";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("axis 2 of the CAN drives is at 12345 microsteps, but at 0"));
  }
}

// The pull is not faster than the file says: measured from the end of the homing.
TEST(ArmEquipment, KeepsTheSpeedOfPretensioning) {
  GrblDeviceConfig board = fast_board();
  board.settings[22] = 1, board.settings[24] = 600, board.settings[25] = 3000;
  board.low = {-9000, -9000, -9000}, board.high = {9000, 9000, 9000};
  const ArmSetup setup(three_tendons(0));
  const double per_metre = setup.drive->axes[0].microsteps_a_metre();
  const auto time_of = [&](double home, double speed) {
    RigEquipment equipment;
    equipment.grbl.resize(1);
    equipment.start = StartPositions::homed;
    equipment.pretension_speed = speed;
    equipment.home = {home, home, home};
    SteppedDevices devices(board, 0);
    const double begin = devices.clock().now();
    const ArmEquipment arm(equipment, setup, devices);
    return devices.clock().now() - begin;
  };
  const double home = -0.004 * per_metre;  // 4 mm
  const double without = time_of(0, 0.002), slow = time_of(home, 0.002), fast = time_of(home, 0.01);
  EXPECT_NEAR(slow - without, 2.0, 0.3);
  EXPECT_NEAR(fast - without, 0.4, 0.3);
}

TEST(ArmEquipment, RefusesAStartThatTheControllerClamps) {
  GrblDeviceConfig board = fast_board();
  board.settings[22] = 1, board.settings[24] = 600, board.settings[25] = 3000;
  board.low = {-9000, -9000, -9000}, board.high = {9000, 9000, 9000};
  const ArmSetup setup(three_tendons(0));
  RigEquipment equipment;
  equipment.grbl.resize(1);
  equipment.start = StartPositions::homed;
  equipment.home = {9000, 9000, 9000};
  // Soft limits end 70 mm, 7000 microsteps, below the switch.
  board.settings[20] = 1;
  for (const int axis : {130, 131, 132}) board.settings[axis] = 70;
  SteppedDevices devices(board, 0);
  try {
    const ArmEquipment arm(equipment, setup, devices);
    FAIL() << "the motors cannot come to the initial shape";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("instead of 0"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace flexura
