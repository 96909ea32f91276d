#include "flexura/math/se3.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// Angles of all sizes, including those around the change to series.
Vector6d random_twist(TestRandom& random) {
  Vector6d twist = random.vector<6>(-1.0, 1.0);
  const double angle =
      random.integer(0, 1) == 0 ? random.uniform(0.0, 6.0) : std::pow(10.0, random.uniform(-12.0, 0.3));
  twist.tail<3>() *= angle / twist.tail<3>().norm();
  return twist;
}

Eigen::Matrix4d hat(const Vector6d& twist) {
  Eigen::Matrix4d result = Eigen::Matrix4d::Zero();
  result.topLeftCorner<3, 3>() = skew(twist.tail<3>());
  result.topRightCorner<3, 1>() = twist.head<3>();
  return result;
}

TEST(Se3, ExpIsThePowerSeriesOfTheMatrix) {
  for_random_cases(200, [](TestRandom& random) {
    const Vector6d twist = random_twist(random);
    Eigen::Matrix4d power = Eigen::Matrix4d::Identity(), sum = power;
    for (int k = 1; k < 60; ++k) sum += power = power * hat(twist) / k;
    const Pose pose = se3_exp(twist);
    EXPECT_LE((pose.rotation - sum.topLeftCorner<3, 3>()).norm(), 1e-12);
    EXPECT_LE((pose.position - sum.topRightCorner<3, 1>()).norm(), 1e-12);
  });
}

TEST(Se3, TheJacobianIsThePowerSeriesOfAd) {
  for_random_cases(200, [](TestRandom& random) {
    const TwistExponential exponential(random_twist(random));
    Matrix6d power = Matrix6d::Identity(), sum = power;
    for (int k = 1; k < 60; ++k) sum += power = power * ad(exponential.twist) / (k + 1);
    EXPECT_LE((exponential.jacobian - sum).norm(), 1e-12);
  });
}

TEST(Se3, TheJacobianIsTheDerivativeOfExp) {
  for_random_cases(50, [](TestRandom& random) {
    const TwistExponential exponential(random_twist(random));
    const auto moved = [&](const Eigen::VectorXd& change) {
      const Pose pose = se3_exp(exponential.twist + change);
      const Pose by = pose * exponential.pose.inverse();
      Eigen::VectorXd twist(6);
      twist << by.position, so3_log(by.rotation);
      return twist;
    };
    const NumericalJacobian numerical = numerical_jacobian(moved, Eigen::VectorXd::Zero(6), 0.02);
    EXPECT_LE((exponential.jacobian - numerical.value).norm(), 1e-8);
  });
}

TEST(Se3, TheFormIsTheDerivativeOfTheJacobian) {
  for_random_cases(50, [](TestRandom& random) {
    const TwistExponential exponential(random_twist(random));
    const Vector6d W = random.vector<6>(-1.0, 1.0), b = random.vector<6>(-1.0, 1.0);
    const auto paired = [&](const Eigen::VectorXd& change) {
      return Eigen::VectorXd::Constant(1, W.dot(TwistExponential(exponential.twist + change).jacobian * b));
    };
    const NumericalJacobian numerical = numerical_jacobian(paired, Eigen::VectorXd::Zero(6), 0.02);
    EXPECT_LE((exponential.jacobian_form(W) * b - numerical.value.transpose()).norm(), 1e-8);
  });
}

TEST(Se3, BracketsAndAdjointsAgree) {
  for_random_cases(100, [](TestRandom& random) {
    const Vector6d a = random.vector<6>(-1.0, 1.0), b = random.vector<6>(-1.0, 1.0),
                   W = random.vector<6>(-1.0, 1.0);
    EXPECT_LE((ad(a) * b - bracket(a, b)).norm(), 1e-15);
    EXPECT_NEAR(W.dot(bracket(a, b)), a.dot(bracket_form(W) * b), 1e-14);
    const Pose X = se3_exp(random_twist(random));
    EXPECT_LE((adjoint(X) * bracket(a, b) - bracket(adjoint(X) * a, adjoint(X) * b)).norm(), 1e-13);
    const Eigen::Matrix4d product = hat(a) * hat(b) - hat(b) * hat(a);
    EXPECT_LE((product - hat(bracket(a, b))).norm(), 1e-14);
  });
}

}  // namespace
}  // namespace flexura
