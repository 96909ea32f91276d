#include "flexura/math/oscillator.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(Oscillator, SolvesItsEquation) {
  for_random_cases(200, [](TestRandom& random) {
    const double frequency = random.uniform(0.5, 200), damping = random.uniform(0, 0.98),
                 duration = random.uniform(0, 0.2);
    // Classical Runge-Kutta of fourth order as the second way.
    Eigen::Matrix2d A;
    A << 0, 1, -frequency * frequency, -2 * damping * frequency;
    Eigen::Matrix2d by_steps = Eigen::Matrix2d::Identity();
    const int steps = 50 + static_cast<int>(200 * frequency * duration);
    const double h = duration / steps;
    for (int i = 0; i < steps; ++i) {
      const Eigen::Matrix2d k1 = A * by_steps, k2 = A * (by_steps + h / 2 * k1),
                            k3 = A * (by_steps + h / 2 * k2), k4 = A * (by_steps + h * k3);
      by_steps += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    const double scale = std::max(1.0, frequency);
    EXPECT_LT((oscillation(frequency, damping, duration) - by_steps).cwiseAbs().maxCoeff(), 1e-7 * scale);
  });
}

TEST(Oscillator, KeepsTheEnergyWithoutDampingAndLosesItWith) {
  for_random_cases(200, [](TestRandom& random) {
    const double frequency = random.uniform(0.5, 200), duration = random.uniform(0, 2);
    const Eigen::Vector2d start = random.vector<2>(-1, 1);
    const auto energy = [&](const Eigen::Vector2d& x) {
      return x[1] * x[1] + frequency * frequency * x[0] * x[0];
    };
    EXPECT_NEAR(energy(oscillation(frequency, 0, duration) * start) / energy(start), 1, 1e-9);
    const double damping = random.uniform(0, 3);
    EXPECT_LE(energy(oscillation(frequency, damping, duration) * start), (1 + 1e-9) * energy(start));
  });
}

}  // namespace
}  // namespace flexura
