#include "flexura/estimate/swing_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "flexura/math/oscillator.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr Eigen::Index arcs = 4, bends = 2;
constexpr double frame = 1.0 / 30;

std::vector<SwingMode> random_modes(TestRandom& random) {
  std::vector<SwingMode> modes(2);
  for (std::size_t j = 0; j < modes.size(); ++j) {
    modes[j].frequency = j == 0 ? random.uniform(6, 10) : random.uniform(16, 25);
    modes[j].damping = 0.03;
    modes[j].shape = Eigen::VectorXd::Zero(3 * arcs);
    for (Eigen::Index arc = 0; arc < arcs; ++arc)
      modes[j].shape.segment<2>(3 * arc) = random.vector<2>(-1, 1);
    modes[j].kick = Eigen::VectorXd::Zero(3);
  }
  return modes;
}

// An arm that swings with other frequencies than its model's, seen in noisy pictures of its bends.
struct Scene {
  explicit Scene(TestRandom& given) : random(given), modes(random_modes(given)) {
    for (int j = 0; j < 2; ++j) {
      factor[j] = random.uniform(0.75, 1.25);
      // The model's kick is wrong by up to 20 %.
      kicks[j] = random.uniform(0.5, 1.0);
      truth[2 * j + 1] = random.uniform(0.8, 1.2) * kicks[j];
    }
  }
  // Moves the truth by a frame and returns the bends.
  Eigen::VectorXd next() {
    Eigen::VectorXd seen = Eigen::VectorXd::Zero(bends * arcs);
    for (int j = 0; j < 2; ++j) {
      const SwingMode& mode = modes[static_cast<std::size_t>(j)];
      truth.segment<2>(2 * j) =
          oscillation(factor[j] * mode.frequency, factor[j] * mode.damping, frame) * truth.segment<2>(2 * j);
      for (Eigen::Index arc = 0; arc < arcs; ++arc)
        seen.segment<2>(bends * arc) += truth[2 * j] * mode.shape.segment<2>(3 * arc);
    }
    return seen;
  }
  TestRandom& random;
  std::vector<SwingMode> modes;
  double factor[2] = {1, 1};
  Eigen::Vector2d kicks;
  Eigen::Vector4d truth = Eigen::Vector4d::Zero();  // z and z' of each mode.
};

TEST(SwingFilter, FindsTheSwingAndItsFrequencies) {
  for_random_cases(20, [](TestRandom& random) {
    Scene scene(random);
    constexpr double noise = 1e-3;
    SwingFilter filter;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(bends * arcs);
    Eigen::MatrixXd P = noise * noise * Eigen::MatrixXd::Identity(bends * arcs, bends * arcs);
    const Eigen::MatrixXd R = P;
    SwingPath path{.modes = scene.modes, .parts = {{.duration = frame, .kicks = Eigen::VectorXd::Zero(2)}}};
    for (int k = 0; k < 150; ++k) {
      path.parts[0].kicks = k == 0 ? scene.kicks : Eigen::Vector2d(0, 0);
      P.diagonal().array() += 1e-4 * 1e-4;
      const Eigen::VectorXd change = filter.predict(path, bends, P);
      for (Eigen::Index arc = 0; arc < arcs; ++arc)
        mean.segment<2>(bends * arc) += change.segment<2>(3 * arc);
      Eigen::VectorXd seen = scene.next();
      for (double& number : seen) number += noise * normal_number(random);
      // The pictures' fit is a Kalman filter's update of the bends.
      const Eigen::MatrixXd gain = P * (P + R).inverse();
      const Eigen::VectorXd innovation = gain * (seen - mean);
      const Eigen::MatrixXd after = (Eigen::MatrixXd::Identity(P.rows(), P.rows()) - gain) * P;
      filter.update(innovation, P, after, true);
      mean += innovation, P = 0.5 * (after + after.transpose());
    }
    for (Eigen::Index j = 0; j < 2; ++j)
      EXPECT_NEAR(filter.frequency_factors()[j] / scene.factor[j], 1, 0.03) << "mode " << j;
    // The shape is split into swing and rest, and the swing a fifth of a second later is foreseen.
    SwingPath later{.modes = scene.modes,
                    .parts = {{.duration = 6 * frame, .kicks = Eigen::VectorXd::Zero(2)}}};
    const Eigen::VectorXd predicted = filter.after(later);
    for (int k = 0; k < 6; ++k) (void)scene.next();
    for (Eigen::Index j = 0; j < 2; ++j) EXPECT_NEAR(predicted[j], scene.truth[2 * j], 5e-3) << "mode " << j;
  });
}

TEST(SwingFilter, KicksMoveTheArmAsTheModeSays) {
  SwingFilter filter;
  std::vector<SwingMode> modes(1);
  modes[0] = {.frequency = 10, .damping = 0.1, .shape = Eigen::VectorXd::Zero(3), .kick = {}};
  modes[0].shape[1] = 1;
  SwingPath path{.modes = modes, .parts = {{.duration = 0.05, .kicks = Eigen::VectorXd::Constant(1, 0.3)}}};
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::VectorXd change = filter.predict(path, bends, P);
  EXPECT_NEAR(change[1], 0.3 * oscillation(10, 0.1, 0.05)(0, 1), 1e-12);
  EXPECT_EQ(change[0], 0);
  EXPECT_GT(P(1, 1), 1);
  EXPECT_EQ(P(0, 0), 1);
}

TEST(SwingFilter, IsNothingWithoutModes) {
  SwingFilter filter;
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(4, 4);
  EXPECT_EQ(filter.predict({}, bends, P).size(), 0);
  filter.update(Eigen::VectorXd::Ones(4), P, P, true);
  EXPECT_FALSE(filter.is_tracked());
  EXPECT_EQ(P, Eigen::MatrixXd::Identity(4, 4));
  EXPECT_EQ(filter.after({}).size(), 0);
}

}  // namespace
}  // namespace flexura
