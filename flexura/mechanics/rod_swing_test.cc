#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <vector>

#include "flexura/math/dense.h"
#include "flexura/math/oscillator.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_response.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// A wire in two sections that its tendons bend, with a mass per length.
ArmConfig swinging_arm() {
  ArmConfig arm;
  arm.kind = ArmKind::spatial;
  arm.mechanics = ArmMechanics::dynamics;
  arm.gravity = {0, -9.81, 0};
  arm.section.resize(2);
  int count = 0;
  for (Section& section : arm.section) {
    section.length = 0.35;
    section.max_bend = 2.2;
    section.bend_profile.emplace(3, 1.0);
    section.material = MaterialConfig{.youngs_modulus = 54e9,
                                      .radius = std::array{2e-3, 2e-3},
                                      .mass_per_length = 0.15,
                                      .damping_time = 0.002};
    ++count;
    for (int i = 0; i < 3; ++i)
      arm.tendon.push_back({.section = count,
                            .radius = 0.015,
                            .angle = (120 * i + 40 * count) * std::numbers::pi / 180,
                            .compliance = 3e-5});
  }
  return arm;
}

ArmState random_command(TestRandom& random) {
  ArmState state = ArmState::straight(2);
  for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-0.8, 0.8);
  return state;
}

TEST(RodSwing, FrequenciesAndDampingAreThoseOfTheLinearMotion) {
  for_random_cases(8, [](TestRandom& random) {
    const ArmConfig config = swinging_arm();
    const ArmModel model = arm_model_of(config, std::nullopt);
    const ArmState command = random_command(random);
    const std::vector<SwingMode> modes = model.actuation().swing(command, 4);
    ASSERT_EQ(modes.size(), 4u);
    // Eigenvalues of the general linear model as the second way.
    const Rod rod = rod_of(config);
    RodStatics statics(rod);
    const TendonInput tendons{.displacements = arc_displacements(rod, command).pulled};
    const Equilibrium at = statics.solve(tendons, loads_of(config));
    ASSERT_TRUE(at.converged());
    RodDynamics dynamics(rod);
    const GeneralEigen eigen =
        general_eigen(dynamics.linearize(dynamics.rest(at), tendons, loads_of(config)).A_rest);
    for (const SwingMode& mode : modes) {
      double nearest = 1;
      for (const std::complex<double>& value : eigen.values) {
        const double frequency = std::abs(value), damping = -value.real() / frequency;
        nearest =
            std::min(nearest, std::abs(frequency / mode.frequency - 1) + std::abs(damping - mode.damping));
      }
      EXPECT_LT(nearest, 0.02) << mode.frequency;
      EXPECT_NEAR(mode.shape.cwiseAbs().maxCoeff(), 1, 1e-9);
    }
  });
}

// The modes of a small motion of the command are those of the full dynamics.
TEST(RodSwing, KicksAndShapesAreThoseOfTheFullMotion) {
  for_random_cases(4, [](TestRandom& random) {
    const ArmConfig config = swinging_arm();
    const ArmModel model = arm_model_of(config, std::nullopt);
    const ArmState command = random_command(random);
    const std::vector<SwingMode> modes = model.actuation().swing(command, 12);
    const Rod rod = rod_of(config);
    const RodLoads loads = loads_of(config);
    RodStatics statics(rod);
    const auto pulled = [&](const ArmState& state) { return arc_displacements(rod, state).pulled; };
    const Equilibrium at = statics.solve({.displacements = pulled(command)}, loads);
    ASSERT_TRUE(at.converged());
    RodDynamics dynamics(rod, {.spectral_radius = 0.9});
    RodState state = dynamics.rest(at);
    // The command moves at a small constant rate from time 0 on.
    ArmState rate = ArmState::straight(2);
    Eigen::VectorXd kick(6);
    for (std::size_t i = 0; i < 2; ++i) {
      rate.bends[i] = random.vector<2>(-0.02, 0.02);
      kick.segment<3>(3 * static_cast<Eigen::Index>(i)) << rate.bends[i], 0;
    }
    constexpr double h = 5e-4;
    double worst = 0, largest = 0;
    for (int k = 1; k <= 400; ++k) {
      const auto at_time = [&](double time) {
        ArmState u = command;
        for (std::size_t i = 0; i < 2; ++i) u.bends[i] += time * rate.bends[i];
        return u;
      };
      ASSERT_TRUE(dynamics.step(state, {.displacements = pulled(at_time((k - 1 + 1 / 1.9) * h))}, loads, h)
                      .converged());
      if (k % 40 != 0) continue;
      // Tip of the full motion against that of the rod at rest plus the modes.
      const double time = k * h;
      Eigen::VectorXd swing = Eigen::VectorXd::Zero(18);
      for (const SwingMode& mode : modes)
        swing += mode.shape * oscillation(mode.frequency, mode.damping, time)(0, 1) * mode.kick.dot(kick);
      ArmState shape = model.actuation().shape(at_time(time));
      const Eigen::Vector3d rest = model.backbone_of_shape(shape).tip().position;
      for (std::size_t i = 0; i < 6; ++i)
        shape.bends[i] += swing.segment<2>(3 * static_cast<Eigen::Index>(i));
      const Eigen::Vector3d predicted = model.backbone_of_shape(shape).tip().position;
      const Equilibrium quasi = statics.solve({.displacements = pulled(at_time(time))}, loads, at);
      const Eigen::Vector3d moved =
          config.arm().X_WB.rotation * (dynamics.tip(state).position - quasi.tip.position);
      worst = std::max(worst, (moved - (predicted - rest)).norm());
      largest = std::max(largest, moved.norm());
    }
    EXPECT_GT(largest, 1e-5);
    EXPECT_LT(worst, 0.05 * largest);
  });
}

TEST(RodSwing, IsEmptyForAnArmWithoutInertia) {
  ArmConfig config = swinging_arm();
  config.mechanics = ArmMechanics::statics;
  EXPECT_TRUE(arm_model_of(config, std::nullopt).actuation().swing(ArmState::straight(2), 4).empty());
  config.mechanics = ArmMechanics::kinematic;
  EXPECT_TRUE(arm_model_of(config, std::nullopt).actuation().swing(ArmState::straight(2), 4).empty());
}

}  // namespace
}  // namespace flexura
