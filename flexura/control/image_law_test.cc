#include "flexura/control/image_law.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "flexura/control/feature_images.h"
#include "flexura/control/jacobian_estimate.h"
#include "flexura/control/limiter.h"
#include "flexura/math/dense.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

constexpr double dt = 1.0 / 30;

TEST(ImageLaw, TellsWhatItCannotSee) {
  // One camera sees a straight arm end on: nothing of its stretch.
  Arm arm = servo_arm();
  for (Section& section : arm.sections) section.stretch_limits = {0.9, 1.1};
  const ImageLaw law(arm, {});
  EXPECT_EQ(law.variables().size(), 9);
  View above = servo_views()[0];
  above.X_WC.position = {0, 3, 0};
  above.X_WC.rotation << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const ArmState straight = ArmState::straight(3);
  Eigen::VectorXd seen;
  Eigen::MatrixXd by_state;
  ASSERT_TRUE(
      FeatureImages(arm, FeatureSet::of_points(6)).derive(straight, std::array{above}, seen, by_state));
  const Eigen::MatrixXd J = law.by_variables(by_state);
  const ImageStep step = law.step(straight, Eigen::VectorXd::Ones(12), J, dt);
  EXPECT_TRUE(step.is_singular);
  EXPECT_TRUE(step.asked.bends[0].allFinite());
  // A value that is not a number must reach the limiter unchanged.
  const ImageStep lost = law.step(straight, Eigen::VectorXd::Constant(12, std::nan("")), J, dt);
  EXPECT_FALSE(lost.asked.bends[0].allFinite());
  CommandLimiter limiter(arm, {.looks_ahead = false}, straight);
  EXPECT_TRUE(limiter.next(lost.asked).is_at_rest);
  EXPECT_TRUE(limiter.fault().has_value());
  EXPECT_THROW((void)law.step(straight, Eigen::VectorXd::Ones(11), J, dt), std::invalid_argument);
  EXPECT_THROW(ImageLaw(arm, {.rate = 0}), std::invalid_argument);
}

// Returns J with singular values that decrease evenly, in powers, to `least`.
Eigen::MatrixXd with_singular_values(TestRandom& random, Eigen::Index rows, Eigen::Index columns,
                                     double least) {
  const auto orthogonal = [&random](Eigen::Index n) {
    Eigen::MatrixXd A(n, n);
    for (double& entry : A.reshaped()) entry = random.uniform(-1, 1);
    return symmetric_eigen(A).vectors;
  };
  const Eigen::MatrixXd U = orthogonal(rows).leftCols(columns), V = orthogonal(columns);
  Eigen::VectorXd values(columns);
  for (Eigen::Index i = 0; i < columns; ++i)
    values[i] = 300 * std::pow(least, static_cast<double>(i) / static_cast<double>(columns - 1));
  return U * values.asDiagonal() * V.transpose();
}

TEST(ImageLaw, KnowsSingularDirectionsAsTheSingularValuesDo) {
  const Arm arm = servo_arm();
  const ImageLaw law(arm, {.damping = 0, .most_step = 1e6});
  const ArmState straight = ArmState::straight(3);
  for_random_cases(200, [&](TestRandom& random) {
    const Eigen::Index rows = random.integer(6, 60);
    const double least = std::pow(10, random.uniform(-16, 0));
    const Eigen::MatrixXd J = with_singular_values(random, rows, 6, least);
    const Eigen::VectorXd error = Eigen::VectorXd::Ones(rows);
    const ImageStep step = law.step(straight, error, J, dt);
    EXPECT_LE(step.reciprocal_condition, least * (1 + 1e-4) + 1e-13);
    EXPECT_GE(step.reciprocal_condition, least / 6 * (1 - 1e-4) - 1e-13);
    if (least <= 1e-5) {
      EXPECT_NEAR(step.reciprocal_condition, least, 1e-13 + 1e-6 * least);
    }
    const bool is_near = std::abs(least - 1e-6) < 1e-9;
    if (!is_near) {
      EXPECT_EQ(step.is_singular, least < 1e-6) << least;
    }
  });
}

TEST(ImageLaw, StepsAsTheLeastSquaresOfTheTallMatrixDo) {
  const Arm arm = servo_arm();
  const ArmState straight = ArmState::straight(3);
  for_random_cases(100, [&](TestRandom& random) {
    const double damping = random.integer(0, 1) == 0 ? 0 : 0.01, least = std::pow(10, random.uniform(-3, 0));
    const ImageLaw law(arm, {.rate = 3, .damping = damping, .most_step = 1e6});
    const Eigen::Index rows = random.integer(6, 200);
    const Eigen::MatrixXd J = with_singular_values(random, rows, 6, least);
    Eigen::VectorXd error(rows);
    for (double& one : error) one = random.uniform(-1e-3, 1e-3);
    // Damping as rows below J: an orthogonal decomposition squares nothing.
    Eigen::MatrixXd tall(rows + 6, 6);
    tall << J, Eigen::MatrixXd::Identity(6, 6) * damping * std::sqrt(J.squaredNorm() / 6);
    Eigen::VectorXd right(rows + 6);
    right << error, Eigen::VectorXd::Zero(6);
    const Eigen::VectorXd desired = (std::exp(-3 * dt) - 1) * least_norm_solution(tall, right);
    const ImageStep step = law.step(straight, error, J, dt);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LE((step.asked.bends[i] - desired.segment<2>(2 * static_cast<Eigen::Index>(i))).norm(),
                1e-13 * desired.norm() / (least * least));
  });
}

TEST(JacobianEstimates, FindALinearMapAfterAsManyMotionsAsItHasColumns) {
  for_random_cases(40, [](TestRandom& random) {
    const Eigen::Index n = random.integer(2, 6), m = random.integer(2, 12);
    const auto any = [&](Eigen::Index rows, Eigen::Index columns) {
      Eigen::MatrixXd A(rows, columns);
      for (double& entry : A.reshaped()) entry = random.uniform(-1, 1);
      return A;
    };
    const Eigen::MatrixXd truth = any(m, n);
    BroydenEstimate broyden(any(m, n));
    RecursiveEstimate recursive(any(m, n), 1, 1e8);
    for (Eigen::Index k = 0; k < n; ++k) {
      // Broyden's update keeps everything about motions perpendicular to the newest.
      const Eigen::VectorXd dx = 0.3 * Eigen::VectorXd::Unit(n, k), other = any(n, 1);
      EXPECT_TRUE(broyden.learn(dx, truth * dx));
      EXPECT_LE((broyden.jacobian() * dx - truth * dx).norm(), 1e-12);
      EXPECT_TRUE(recursive.learn(other, truth * other));
    }
    EXPECT_LE((broyden.jacobian() - truth).norm(), 1e-12);
    for (int k = 0; k < 20; ++k) {
      const Eigen::VectorXd other = any(n, 1);
      recursive.learn(other, truth * other);
    }
    EXPECT_LE((recursive.jacobian() - truth).norm(), 1e-5);
    const Eigen::MatrixXd before = broyden.jacobian();
    EXPECT_FALSE(broyden.learn(Eigen::VectorXd::Zero(n), Eigen::VectorXd::Ones(m)));
    EXPECT_FALSE(recursive.learn(Eigen::VectorXd::Ones(n), Eigen::VectorXd::Constant(m, std::nan(""))));
    EXPECT_EQ(broyden.jacobian(), before);
    EXPECT_THROW(broyden.learn(Eigen::VectorXd::Ones(n + 1), Eigen::VectorXd::Ones(m)),
                 std::invalid_argument);
  });
  EXPECT_THROW(BroydenEstimate(Eigen::MatrixXd::Identity(2, 2), 0), std::invalid_argument);
  EXPECT_THROW(RecursiveEstimate(Eigen::MatrixXd::Identity(2, 2), 1.1), std::invalid_argument);
}

TEST(JacobianEstimates, FollowAMapThatChanges) {
  TestRandom random(3);
  RecursiveEstimate recursive(Eigen::MatrixXd::Zero(2, 2), 0.8);
  Eigen::Matrix2d truth = Eigen::Matrix2d::Identity();
  for (int k = 0; k < 400; ++k) {
    if (k == 200) truth << 0, 2, -1, 0;
    // The arm rests for a while: the estimate must not grow without bound.
    if (k > 50 && k < 150) recursive.learn(Eigen::Vector2d(1e-5, 0), truth * Eigen::Vector2d(1e-5, 0));
    const Eigen::Vector2d dx = random.vector<2>(-0.1, 0.1);
    recursive.learn(dx, truth * dx);
    if (k == 199 || k == 399) {
      EXPECT_LE((recursive.jacobian() - truth).norm(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace flexura
