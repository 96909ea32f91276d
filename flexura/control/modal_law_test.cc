#include "flexura/control/modal_law.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "flexura/math/oscillator.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double short_step = 5e-4;

// A planar arm of one section whose only motion is a mode: the equilibrium equals the command, and the bend
// is the command plus z.
struct OneMode {
  OneMode(double frequency, double damping) : arm() {
    arm.kind = ArmKind::planar;
    arm.sections.resize(1);
    arm.sections[0].length = 1, arm.sections[0].max_bend = 10, arm.sections[0].max_bend_rate = 1e6;
    mode.frequency = frequency, mode.damping = damping;
    mode.shape = Eigen::Vector3d(1, 0, 0);
    mode.kick = Eigen::Vector3d(-1, 0, 0);
  }
  // Moves to a command over a step. With y = x - u + 2 zeta u' / w, y swings freely.
  void go(const ArmState& to) {
    const double u = sent.bends[0].x(), u_rate = (to.bends[0].x() - u) / short_step,
                 w = factor * mode.frequency, zeta = factor * mode.damping, ahead = 2 * zeta / w * u_rate;
    const Eigen::Vector2d y =
        oscillation(w, zeta, short_step) * Eigen::Vector2d(x - u + ahead, x_rate - u_rate);
    x = y[0] + to.bends[0].x() - ahead, x_rate = y[1] + u_rate;
    sent = to, rate = u_rate;
  }
  [[nodiscard]] PredictiveState state(double desired) const {
    return {.sent = sent,
            .rate = {{Eigen::Vector2d(rate, 0)}, {0}},
            .rest = sent,
            .desired = {{{desired, 0}}, {1}},
            .modes = {mode},
            .swing = Eigen::Vector2d(x - sent.bends[0].x(), x_rate - rate),
            .frequency_factors = Eigen::VectorXd::Constant(1, factor)};
  }
  [[nodiscard]] double bend() const { return x; }
  Arm arm;
  SwingMode mode;
  double rate = 0;    // Of the command, rad/s.
  double factor = 1;  // Of the true frequency over the model's.
  ArmState sent = ArmState::straight(1);
  double x = 0, x_rate = 0;  // Of the arm, rad and rad/s.
};

// With steps that are short against the mode, the error follows (1 + r t) exp(-r t), whatever the mode is.
TEST(ModalLaw, ComputedTorqueGivesTheErrorItsOwnDynamics) {
  for_random_cases(50, [](TestRandom& random) {
    OneMode plant(random.uniform(3, 30), random.uniform(0, 0.03));
    plant.factor = random.uniform(0.7, 1.4);
    const double rate = random.uniform(2, 6), desired = random.uniform(-1, 1);
    const ModalLaw law(plant.arm, {.step = short_step, .rate = rate});
    for (int i = 1; i <= 4000; ++i) {
      plant.go(law.step(plant.state(desired), Eigen::Matrix3d::Identity()));
      const double t = i * short_step, left = (1 + rate * t) * std::exp(-rate * t);
      ASSERT_NEAR(plant.bend() - desired, -desired * left, 0.05 * std::abs(desired)) << "at " << t;
    }
  });
}

// A target that moves at a constant rate is followed without an error.
TEST(ModalLaw, ComputedTorqueFollowsARamp) {
  for_random_cases(20, [](TestRandom& random) {
    OneMode plant(random.uniform(3, 30), random.uniform(0, 0.03));
    const double rate = random.uniform(2, 6), speed = random.uniform(-0.5, 0.5);
    const ModalLaw law(plant.arm, {.step = short_step, .rate = rate});
    double error = 0;
    for (int i = 0; i < 8000; ++i) {
      const double time = i * short_step;
      PredictiveState now = plant.state(speed * time);
      for (int k = 1; k <= 12; ++k)
        now.desired_later.push_back({{{speed * (time + k * short_step), 0}}, {1}});
      plant.go(law.step(now, Eigen::Matrix3d::Identity()));
      error = plant.bend() - speed * (time + short_step);
    }
    EXPECT_NEAR(error, 0, 0.01 * std::abs(speed));
  });
}

// The potential's energy with the kinetic one never grows, and the arm stops at the target.
TEST(ModalLaw, ThePotentialDissipates) {
  for_random_cases(50, [](TestRandom& random) {
    OneMode plant(random.uniform(3, 30), random.uniform(0, 0.02));
    const double rate = random.uniform(2, 6), desired = random.uniform(-1, 1);
    const ModalLaw law(plant.arm, {.kind = ModalLawKind::potential, .step = short_step, .rate = rate});
    const double w = plant.mode.frequency, share = std::min(1.0, rate * rate / (w * w));
    const auto energy = [&] {
      return 0.5 * plant.x_rate * plant.x_rate + 0.5 * share * w * w * std::pow(plant.bend() - desired, 2);
    };
    const double first = energy();
    double before = first;
    for (int i = 0; i < 12000; ++i) {
      plant.go(law.step(plant.state(desired), Eigen::Matrix3d::Identity()));
      // Within the first-order error of the steps.
      ASSERT_LE(energy(), before + 1e-3 * first);
      before = energy();
    }
    EXPECT_NEAR(plant.bend(), desired, 0.05 * std::abs(desired));
  });
}

TEST(ModalLaw, WithoutModesResolvesTheRateOfTheShape) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.resize(2);
  for (Section& section : arm.sections) section.length = 0.5;
  const ModalLaw law(arm, {.step = 0.05, .rate = 4});
  const ArmState from{{{0.1, 0.2}, {0.3, 0}}, {1, 1}}, to{{{0.5, 0}, {-0.2, 0.6}}, {1, 1}};
  const ArmState still{{{0, 0}, {0, 0}}, {0, 0}};
  const ArmState next = law.step({.sent = from, .rate = still, .rest = from, .desired = to},
                                 Eigen::Matrix<double, 6, 6>::Identity());
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LE((next.bends[i] - (from.bends[i] + 0.2 * (to.bends[i] - from.bends[i]))).norm(), 1e-12);
  EXPECT_THROW((void)ModalLaw(arm, {.step = 0}), std::invalid_argument);
  EXPECT_THROW((void)ModalLaw(arm, {.rate = std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
