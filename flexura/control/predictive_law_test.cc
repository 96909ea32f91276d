#include "flexura/control/predictive_law.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/math/oscillator.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double command_step = 1.0 / 30;

Arm small_arm(double max_bend, double max_rate) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.resize(2);
  for (Section& section : arm.sections)
    section.length = 0.5, section.max_bend = max_bend, section.max_bend_rate = max_rate;
  return arm;
}

// An arm that follows its commands and swings in one mode.
struct Swinging {
  explicit Swinging(double frequency) : truth(frequency) {
    mode.frequency = frequency, mode.damping = 0.02;
    mode.shape = Eigen::VectorXd::Zero(6);
    mode.shape[0] = 1, mode.shape[3] = 0.7;
    mode.kick = Eigen::VectorXd::Zero(6);
    mode.kick[0] = -1.5, mode.kick[3] = -0.5;
  }
  // Moves to a command over one step.
  void go(const ArmState& to) {
    Eigen::VectorXd kick(6);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::Vector2d now = (to.bends[k] - sent.bends[k]) / command_step;
      kick.segment<3>(3 * i) << now - rate.bends[k], 0;
      rate.bends[k] = now;
    }
    rate.stretches = {0, 0};
    z = oscillation(truth, mode.damping, command_step) * Eigen::Vector2d(z[0], z[1] + mode.kick.dot(kick));
    sent = to;
  }
  [[nodiscard]] PredictiveState state(const ArmState& desired) const {
    return {.sent = sent,
            .rate = rate,
            .rest = sent,
            .desired = desired,
            .modes = {mode},
            .swing = z,
            .frequency_factors = Eigen::VectorXd::Constant(1, truth / mode.frequency)};
  }
  SwingMode mode;
  double truth;
  ArmState sent = ArmState::straight(2);
  ArmState rate = {std::vector<Eigen::Vector2d>(2, Eigen::Vector2d::Zero()), {0, 0}};
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
};

double distance(const ArmState& a, const ArmState& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.bends.size(); ++i) most = std::max(most, (a.bends[i] - b.bends[i]).norm());
  return most;
}

TEST(PredictiveLaw, ReachesTheTargetAndStopsTheSwing) {
  for_random_cases(20, [](TestRandom& random) {
    const Arm arm = small_arm(2, std::numbers::pi / 2);
    PredictiveLaw law(arm, arm, {.step = command_step});
    Swinging plant(random.uniform(5, 25));
    plant.z = random.vector<2>(-0.05, 0.05);
    ArmState target = ArmState::straight(2);
    for (Eigen::Vector2d& bend : target.bends) bend = random.vector<2>(-1.2, 1.2);
    const Eigen::MatrixXd J = Eigen::MatrixXd::Identity(6, 6);
    for (int k = 0; k < 120; ++k) plant.go(law.step(plant.state(target), J));
    EXPECT_LT(distance(plant.sent, target), 2e-3);
    // Alone it would keep 0.9 of its amplitude a second at the least frequency.
    EXPECT_LT(std::abs(plant.z[0]), 2e-3);
    EXPECT_LT(std::abs(plant.z[1]), 2e-2);
  });
}

TEST(PredictiveLaw, StaysWithinTheLimits) {
  for_random_cases(30, [](TestRandom& random) {
    const double max_bend = random.uniform(0.4, 1.5), max_rate = random.uniform(0.5, 2);
    const Arm arm = small_arm(max_bend, max_rate);
    PredictiveLaw law(arm, arm, {.step = command_step, .rate = random.uniform(2, 15)});
    Swinging plant(random.uniform(5, 25));
    ArmState target = ArmState::straight(2);
    // Some targets are beyond the limits.
    for (Eigen::Vector2d& bend : target.bends) bend = random.vector<2>(-2, 2);
    const Eigen::MatrixXd J = Eigen::MatrixXd::Identity(6, 6);
    for (int k = 0; k < 60; ++k) {
      const ArmState before = plant.sent, next = law.step(plant.state(target), J);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LE((next.bends[i] - before.bends[i]).norm(), (1 + 1e-9) * max_rate * command_step);
        EXPECT_LE(next.bends[i].norm(), (1 + 1e-9) * max_bend);
      }
      plant.go(next);
    }
  });
}

TEST(PredictiveLaw, RefusesWhatMakesNoSense) {
  const Arm arm = small_arm(1, 1);
  EXPECT_THROW(PredictiveLaw(arm, arm, {.step = 0}), std::invalid_argument);
  EXPECT_THROW(PredictiveLaw(arm, arm, {.horizon = 0}), std::invalid_argument);
  EXPECT_THROW(PredictiveLaw(arm, arm, {.rate = std::nan("")}), std::invalid_argument);
}

// The target lies beyond a linear limit: the arm stops at it, as near to the target as the limit allows. The
// metric of a small bend counts the second section's bend less than the first one's, so that only the limit
// itself has a closed form.
TEST(PredictiveLaw, KeepsLinearLimits) {
  for_random_cases(20, [](TestRandom& random) {
    const Arm arm = small_arm(2, std::numbers::pi / 2);
    PredictiveLaw law(arm, arm, {.step = command_step, .most_iterations = 400});
    Swinging plant(random.uniform(5, 25));
    Eigen::RowVectorXd normal = Eigen::RowVectorXd::Zero(6);
    for (const Eigen::Index i : {0, 1, 3, 4}) normal[i] = random.uniform(-1, 1);
    normal /= normal.norm();
    const auto product = [&](const ArmState& state) {
      return normal.segment<2>(0).dot(state.bends[0]) + normal.segment<2>(3).dot(state.bends[1]);
    };
    const double most = random.uniform(0.1, 0.4);
    ArmState target = ArmState::straight(2);
    for (std::size_t k = 0; k < 2; ++k)
      target.bends[k] = 0.8 * normal.segment<2>(3 * static_cast<Eigen::Index>(k)).transpose();
    for (int i = 0; i < 150; ++i) {
      PredictiveState now = plant.state(target);
      now.limits = {{normal, most - product(plant.sent)}};
      plant.go(law.step(now, Eigen::MatrixXd::Identity(6, 6)));
      EXPECT_LE(product(plant.sent), most + 0.01) << "step " << i;
    }
    EXPECT_GE(product(plant.sent), most - 0.01);
    EXPECT_EQ(law.active_limit(), std::size_t{0});
    // A limit that is broken already is reached again.
    for (int i = 0; i < 150; ++i) {
      PredictiveState now = plant.state(target);
      now.limits = {{normal, 0.5 * most - product(plant.sent)}};
      plant.go(law.step(now, Eigen::MatrixXd::Identity(6, 6)));
    }
    EXPECT_NEAR(product(plant.sent), 0.5 * most, 0.01);
  });
}

}  // namespace
}  // namespace flexura
