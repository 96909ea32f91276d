#include "flexura/sim/plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "flexura/sim/arm_setup.h"
#include "flexura/sim/simulated_rig.h"
#include "tests/support/random_cases.h"
#include "tests/support/rigs.h"

namespace flexura {
namespace {

// A thin rod that a weight bends: its curve, no chain of few arcs, swings to where u has it, a step of the
// clock after the other.
class SwingingRod : public Plant {
 public:
  explicit SwingingRod(const PlantSetup& setup) : started(setup.start), u_(setup.start) {}

  void command(double time, const Eigen::VectorXd& u, double /*duration*/) override {
    EXPECT_EQ(time, advanced.empty() ? 0 : advanced.back())
        << "the rig's time comes before what is sent in it";
    u_ = u, commanded.push_back(u);
  }
  void halt(double /*time*/) override { u_ = x_, ++halts; }
  void advance(double time) override {
    const double passed = time - (advanced.empty() ? 0 : advanced.back());
    if (x_.size() == 0) x_ = started;
    x_ += (1 - std::exp(-4 * passed)) * (u_ - x_);
    advanced.push_back(time);
  }
  [[nodiscard]] Backbone backbone(double /*time*/) const override { return Backbone::through(samples()); }

  // A cubic curve, which bends the more the nearer to the tip.
  [[nodiscard]] static Eigen::Vector3d point(double t, double aside) {
    return {aside * t * t * t, 0.5 * t, 0.3 * aside * t * t};
  }
  [[nodiscard]] double aside() const { return x_.size() == 0 ? 0 : 1e-5 * (x_ - started).norm(); }

  Eigen::VectorXd started;
  std::vector<Eigen::VectorXd> commanded;
  std::vector<double> advanced;
  int halts = 0;

 private:
  [[nodiscard]] std::vector<BackboneSample> samples() const {
    std::vector<BackboneSample> result;
    for (int i = 0; i <= 20; ++i) {
      const double t = i / 20.0, a = aside();
      const Eigen::Vector3d slope(3 * a * t * t, 0.5, 0.6 * a * t);
      BackboneSample sample;
      sample.X_WS.position = point(t, a);
      sample.X_WS.rotation =
          Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), slope).toRotationMatrix();
      sample.s_rest = 0.5 * t, sample.radius = 0.01, sample.section = t < 0.5 ? 0 : 1;
      result.push_back(sample);
    }
    return result;
  }

  Eigen::VectorXd u_, x_;
};

struct RodRig {
  explicit RodRig(const RigConfig& config)
      : rig(config, config, numbers_renderer, 1, [this](const PlantSetup& setup) {
          auto made = std::make_unique<SwingingRod>(setup);
          rod = made.get();
          return made;
        }) {}
  SwingingRod* rod = nullptr;
  SimulatedRig rig;
};

ArmState half_bent() {
  ArmState state = ArmState::straight(2);
  state.bends[0] = {0.5, 0.2};
  return state;
}

TEST(Plant, ARigTakesAnotherOneAndItsCamerasSeeIt) {
  RodRig rod(two_section_rig());
  const RigPorts ports = rod.rig.ports();
  ASSERT_TRUE(ports.arm->command(half_bent(), 0));
  double last = -1;
  for (int step = 1; step <= 20; ++step) {
    ports.clock->wait_until(0.1 * step);
    const Backbone curve = rod.rig.arm().backbone(0.1 * step);
    EXPECT_GT(curve.arcs().size(), 20U);
    const auto frame = ports.cameras[0].camera->newest().value();
    ASSERT_TRUE(frame);
    const auto numbers = numbers_of(*frame);
    const auto tip = rod.rig.camera(0).view(frame->time).project(SwingingRod::point(1, rod.rod->aside()));
    EXPECT_NEAR(numbers[8], tip->x(), 1e-6);
    EXPECT_NEAR(numbers[9], tip->y(), 1e-6);
    EXPECT_NE(numbers[8], last) << "it swings";
    last = numbers[8];
  }
  EXPECT_GT(rod.rod->aside(), 0.005);
  EXPECT_THROW((void)rod.rig.arm().truth(2), std::logic_error);
}

// By the motors' positions and whatever the plant makes of them, the controller counts what it sent.
TEST(Plant, IsSentTheMotorsPositionsOfWhichTheControllerTells) {
  RodRig rod(two_section_rig());
  const RigPorts ports = rod.rig.ports();
  EXPECT_EQ(rod.rod->started, Eigen::VectorXd::Zero(6));
  ASSERT_TRUE(ports.arm->command(half_bent(), 0.5));
  ports.clock->wait_until(10);
  const ArmReading reading = ports.arm->read().value();
  ASSERT_EQ(rod.rod->commanded.size(), 1U);
  for (int i = 0; i < 6; ++i)
    EXPECT_EQ(rod.rod->commanded[0][i], static_cast<double>(reading.positions[static_cast<std::size_t>(i)]));
  EXPECT_NEAR(reading.state.bends[0].x(), 0.5, 0.01);
  EXPECT_EQ(rod.rod->advanced, std::vector<double>{10});
}

TEST(Plant, OfAnArmWithoutDrivesIsSentBendsAndStretches) {
  RigConfig config = two_section_rig();
  config.drive.reset();
  RodRig rod(config);
  ASSERT_TRUE(rod.rig.ports().arm->command(half_bent(), 0));
  EXPECT_EQ(rod.rod->started, plant_command(ArmState::straight(2)));
  EXPECT_EQ(rod.rod->commanded.at(0), plant_command(half_bent()));
  EXPECT_EQ(commanded_state(rod.rod->commanded[0]), half_bent());
}

TEST(Plant, OfWhichALostLinkKeepsCommandsAway) {
  for (const bool has_drive : {true, false}) {
    RigConfig config = two_section_rig();
    if (!has_drive) config.drive.reset();
    RodRig rod(config);
    rod.rig.arm().link().lose(0, 1);
    EXPECT_EQ(rod.rig.ports().arm->command(half_bent(), 0).fault()->kind, FaultKind::link_lost);
    EXPECT_EQ(rod.rig.ports().arm->halt().fault()->kind, FaultKind::link_lost);
    EXPECT_TRUE(rod.rod->commanded.empty());
    EXPECT_EQ(rod.rod->halts, 0);
    rod.rig.clock().wait_until(2);
    EXPECT_TRUE(rod.rig.ports().arm->command(half_bent(), 0));
    EXPECT_TRUE(rod.rig.ports().arm->halt());
    EXPECT_EQ(rod.rod->commanded.size(), 1U);
    EXPECT_EQ(rod.rod->halts, 1);
  }
}

// Below the arm's port stands a controller that knows of no arm.
TEST(SimulatedDrive, RefusesWhatAreNoTargetsOfItsAxes) {
  RodRig rod(two_section_rig());
  SimulatedDrive& drive = *rod.rig.arm().drive();
  EXPECT_EQ(drive.quantity(), DriveQuantity::motor_positions);
  EXPECT_EQ(drive.command(std::vector<double>(5, 0), 0).fault()->kind, FaultKind::refused);
  EXPECT_EQ(drive.command(std::vector<double>(6, std::nan("")), 0).fault()->kind, FaultKind::refused);
  EXPECT_EQ(drive.command(std::vector<double>(6, 0), -1).fault()->kind, FaultKind::refused);
  EXPECT_TRUE(rod.rod->commanded.empty());
  ASSERT_TRUE(drive.command(std::vector<double>(6, 100), 0));
  rod.rig.clock().wait_until(10);
  const DriveReading reading = drive.read().value();
  EXPECT_EQ(reading.values, std::vector<double>(6, 100));
  EXPECT_EQ(reading.time, 10);
  EXPECT_FALSE(reading.moving);
  // A reversed motor has let cable out, and turned through its play before.
  const double backlash = ArmSetup(two_section_rig()).drive->axes[1].backlash_steps();
  EXPECT_EQ(reading.carried[0], 100);
  EXPECT_NEAR(reading.carried[1], 100 - backlash, 1e-9);
}

}  // namespace
}  // namespace flexura
