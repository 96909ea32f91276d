#include "flexura/math/so3.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "flexura/math/derivative_check.h"
#include "flexura/math/pose.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Eigen::Vector3d random_rotation_vector(TestRandom& random, double largest) {
  return random.uniform(0.0, largest) * random.vector<3>(-1.0, 1.0).normalized();
}

TEST(So3, ExpAgreesWithAngleAndAxis) {
  for_random_cases(500, [](TestRandom& random) {
    const Eigen::Vector3d w = random_rotation_vector(random, 15.0);
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
    EXPECT_LE((so3_exp(w) - expected).cwiseAbs().maxCoeff(), 1e-14);
  });
}

TEST(So3, ADirectionTakesZTheShortestWay) {
  for_random_cases(200, [](TestRandom& random) {
    const Eigen::Vector3d d = random.vector<3>(-1.0, 1.0).normalized();
    const Eigen::Matrix3d R = rotation_from_z(1e-200 * d);
    EXPECT_LE((R.col(2) - d).norm(), 1e-15);
    EXPECT_NEAR(so3_log(R).norm(), std::acos(d.z()), 1e-7);
    EXPECT_LE(std::abs(so3_log(R).z()), 1e-15);
  });
  EXPECT_EQ(rotation_from_z({0.0, 0.0, 2.0}), Eigen::Matrix3d::Identity());
  EXPECT_LE((rotation_from_z({0.0, 0.0, -2.0}) * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitZ()).norm(),
            0.0);
  EXPECT_DOUBLE_EQ(rotation_from_z({0.0, 0.0, -2.0}).determinant(), 1.0);
  EXPECT_LE((rotation_from_z({1e-12, 0.0, -1.0}).col(2) + Eigen::Vector3d::UnitZ()).norm(), 2e-12);
}

TEST(So3, LogUndoesExpFromTinyToAlmostHalfATurn) {
  for (const double angle :
       {0.0, 1e-300, 1e-160, 1e-12, 1e-8, 1e-4, 0.1, 1.0, 3.0, std::numbers::pi - 1e-9}) {
    for_random_cases(20, [&](TestRandom& random) {
      const Eigen::Vector3d w = angle * random.vector<3>(-1.0, 1.0).normalized();
      EXPECT_LE((so3_log(so3_exp(w)) - w).cwiseAbs().maxCoeff(), 2e-15 * angle) << angle;
    });
  }
}

TEST(So3, LogOfAHalfTurnIsTheCanonicalOne) {
  const Eigen::Matrix3d half_turn = Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal();
  EXPECT_LE((so3_log(half_turn) - Eigen::Vector3d(0.0, std::numbers::pi, 0.0)).norm(), 1e-15);
}

TEST(So3, TheLeftJacobianIsTheAngularVelocity) {
  for (const double angle : {0.0, 1e-12, 1e-3, 1.0, 3.0, 6.0, 12.0}) {
    for_random_cases(10, [&](TestRandom& random) {
      const Eigen::Vector3d w = angle * random.vector<3>(-1.0, 1.0).normalized();
      const Eigen::Matrix3d R = so3_exp(w);
      const VectorFunction turn = [&R](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        return so3_log(so3_exp(x) * R.transpose());
      };
      const NumericalJacobian numerical = numerical_jacobian(turn, w);
      EXPECT_LE((so3_left_jacobian(w) - numerical.value).cwiseAbs().maxCoeff(), 1e-11) << angle;
    });
  }
}

TEST(Pose, QuaternionsHaveUnitLengthAndWIsNotNegative) {
  for_random_cases(500, [](TestRandom& random) {
    const Eigen::Vector3d w = random_rotation_vector(random, 6.0);
    const Eigen::Vector4d q = quaternion_wxyz(so3_exp(w));
    EXPECT_NEAR(q.norm(), 1.0, 4e-16);
    EXPECT_GE(q[0], 0.0);
    const Eigen::Quaterniond same(q[0], q[1], q[2], q[3]);
    EXPECT_LE((same.toRotationMatrix() - so3_exp(w)).cwiseAbs().maxCoeff(), 1e-14);
  });
}

TEST(Pose, AQuaternionOfAHalfTurnHasItsFirstComponentPositive) {
  const Eigen::Matrix3d half_turn = Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal();
  EXPECT_EQ(quaternion_wxyz(half_turn), Eigen::Vector4d(0.0, 0.0, 1.0, 0.0));
  for (const double component : quaternion_wxyz(half_turn)) EXPECT_FALSE(std::signbit(component));
}

TEST(Pose, AQuaternionThatIsTurnedRoundHasNoNegativeZeros) {
  const Eigen::Vector4d q = quaternion_wxyz(so3_exp({0.0, 0.0, 4.0}));
  EXPECT_LE((q - Eigen::Vector4d(-std::cos(2.0), 0.0, 0.0, -std::sin(2.0))).norm(), 1e-15);
  for (const double component : q.head<3>()) EXPECT_FALSE(std::signbit(component));
}

TEST(Pose, TheInverseUndoesAPose) {
  for_random_cases(100, [](TestRandom& random) {
    const Pose X_AB{so3_exp(random_rotation_vector(random, 3.0)), random.vector<3>(-5.0, 5.0)};
    const Pose X_AA = X_AB * X_AB.inverse();
    EXPECT_LE((X_AA.rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LE(X_AA.position.norm(), 1e-14);
    const Eigen::Vector3d p_BP = random.vector<3>(-5.0, 5.0);
    EXPECT_LE((X_AB.inverse() * (X_AB * p_BP) - p_BP).norm(), 1e-14);
  });
}

}  // namespace
}  // namespace flexura
