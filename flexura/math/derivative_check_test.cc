#include "flexura/math/derivative_check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexura {
namespace {

TEST(DerivativeCheck, FindsTheJacobianOfAKnownFunctionToTwelveDigits) {
  const VectorFunction f = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return Eigen::Vector3d(std::sin(x[0]) * x[1], std::exp(x[1]), x[0] * x[0]);
  };
  const Eigen::Vector2d x(0.7, -1.3);
  Eigen::MatrixXd expected(3, 2);
  expected << std::cos(0.7) * -1.3, std::sin(0.7), 0.0, std::exp(-1.3), 1.4, 0.0;
  const NumericalJacobian found = numerical_jacobian(f, x);
  EXPECT_LE((found.value - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE(found.error.maxCoeff(), 1e-11);
}

TEST(DerivativeCheck, TellsThatAKinkHasNoDerivativeToTrust) {
  const VectorFunction kink = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return (x.array() - 1e-3).abs().matrix();
  };
  EXPECT_GT(numerical_jacobian(kink, Eigen::VectorXd::Zero(1)).error.maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace flexura
