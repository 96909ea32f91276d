#include "flexura/math/magnus.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "flexura/math/derivative_check.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// A strain that varies along its interval.
struct Way {
  Vector6d constant, linear, wave;
  [[nodiscard]] Vector6d at(double s) const { return constant + s * linear + std::sin(3 * s) * wave; }
};

Pose followed(const Way& way, double length, int steps) {
  const std::array<double, 3> points = magnus_points();
  Pose X;
  const double h = length / steps;
  for (int i = 0; i < steps; ++i) {
    const auto at = [&](std::size_t k) { return way.at((i + points[k]) * h); };
    X = X * se3_exp(MagnusStep(magnus_moments(h, at(0), at(1), at(2))).twist());
  }
  return X;
}

TEST(Magnus, HasTheSixthOrder) {
  for_random_cases(20, [](TestRandom& random) {
    const Way way{random.vector<6>(-1.0, 1.0), random.vector<6>(-1.0, 1.0), random.vector<6>(-1.0, 1.0)};
    const Pose exact = followed(way, 1.5, 512);
    const auto error = [&](int steps) {
      const Pose found = followed(way, 1.5, steps);
      return (found.position - exact.position).norm() + (found.rotation - exact.rotation).norm();
    };
    const double order = std::log2(error(8) / error(16));
    EXPECT_GT(order, 5.5);
    EXPECT_LT(error(16), 1e-7);
  });
}

TEST(Magnus, IsExactForAConstantStrain) {
  for_random_cases(20, [](TestRandom& random) {
    const Vector6d x = random.vector<6>(-2.0, 2.0);
    EXPECT_LE((MagnusStep(magnus_moments(0.7, x, x, x)).twist() - 0.7 * x).norm(), 1e-14);
  });
}

MagnusStep::Moments moments(const Eigen::VectorXd& a) {
  return {a.segment<6>(0), a.segment<6>(6), a.segment<6>(12)};
}

TEST(Magnus, ItsDerivativesAreThoseByDifferences) {
  for_random_cases(30, [](TestRandom& random) {
    const Eigen::VectorXd a = random.vector<18>(-1.0, 1.0);
    const MagnusStep step(moments(a));
    const auto twist = [](const Eigen::VectorXd& at) {
      return Eigen::VectorXd(MagnusStep(moments(at)).twist());
    };
    const NumericalJacobian by_moments = numerical_jacobian(twist, a, 0.1);
    const MagnusStep::Slopes slopes = step.slopes();
    for (std::size_t i = 0; i < 3; ++i) {
      const Matrix6d numerical = by_moments.value.middleCols<6>(6 * static_cast<Eigen::Index>(i));
      EXPECT_LE((slopes[i] - numerical).norm(), 1e-9);
    }

    const Vector6d W = random.vector<6>(-1.0, 1.0);
    const auto gradient = [&](const Eigen::VectorXd& at) {
      const MagnusStep::Slopes by = MagnusStep(moments(at)).slopes();
      Eigen::VectorXd result(18);
      result << by[0].transpose() * W, by[1].transpose() * W, by[2].transpose() * W;
      return result;
    };
    const NumericalJacobian second = numerical_jacobian(gradient, a, 0.1);
    const MagnusStep::Form form = step.form(W);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const Matrix6d numerical =
            second.value.block<6, 6>(6 * static_cast<Eigen::Index>(i), 6 * static_cast<Eigen::Index>(j));
        EXPECT_LE((form[i][j] - numerical).norm(), 1e-9) << i << j;
      }
    }
  });
}

}  // namespace
}  // namespace flexura
