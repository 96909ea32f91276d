// Held against ViSP (GPL): tests only.
#include <gtest/gtest.h>
#include <visp3/core/vpColVector.h>
#include <visp3/core/vpMatrix.h>
#include <visp3/visual_features/vpFeaturePoint.h>
#include <visp3/vs/vpServo.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "flexura/camera/intrinsics.h"
#include "flexura/control/interaction.h"
#include "flexura/math/pose.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

const Lens unit_lens({.fx = 1, .fy = 1, .cx = 0, .cy = 0});

vpFeaturePoint feature_of(const Eigen::Vector3d& p_CP) {
  vpFeaturePoint feature;
  feature.buildFrom(p_CP.x() / p_CP.z(), p_CP.y() / p_CP.z(), p_CP.z());
  return feature;
}

TEST(AgainstViSP, APointsInteractionMatrixIsTheSame) {
  for_random_cases(200, [](TestRandom& random) {
    const Eigen::Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.3, 5));
    const vpMatrix theirs = feature_of(p).interaction();
    const auto ours = point_interaction(unit_lens, p).value();
    ASSERT_EQ(theirs.getRows(), 2U);
    ASSERT_EQ(theirs.getCols(), 6U);
    for (unsigned int row = 0; row < 2; ++row)
      for (unsigned int column = 0; column < 6; ++column)
        EXPECT_NEAR(ours(row, column), theirs[row][column], 1e-13 * (1 + ours.norm()));
  });
}

// The corners of a square and its middle, before a camera at X_WC.
constexpr std::size_t point_count = 5;
std::array<Eigen::Vector3d, point_count> seen_from(const Pose& X_WC) {
  std::array<Eigen::Vector3d, point_count> places = {
      Eigen::Vector3d(-0.1, -0.1, 0), {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}, {0, 0, 0.05}};
  for (Eigen::Vector3d& place : places) place = X_WC.inverse() * place;
  return places;
}

TEST(AgainstViSP, AFreeCameraServosAlike) {
  double apart = 0;
  for_random_cases(20, [&](TestRandom& random) {
    constexpr double gain = 0.8, dt = 0.05;
    const Pose desired{Eigen::Matrix3d::Identity(), {0, 0, -1}};
    Pose X_WC{so3_exp(random.vector<3>(-0.25, 0.25)),
              Eigen::Vector3d(0, 0, -1) + random.vector<3>(-0.2, 0.2)};
    std::array<vpFeaturePoint, point_count> now, wanted;
    vpServo task;
    task.setServo(vpServo::EYEINHAND_CAMERA);
    task.setInteractionMatrixType(vpServo::CURRENT);
    task.setLambda(gain);
    const auto goal = seen_from(desired);
    for (std::size_t i = 0; i < point_count; ++i) {
      now[i] = feature_of(seen_from(X_WC)[i]), wanted[i] = feature_of(goal[i]);
      task.addFeature(now[i], wanted[i]);
    }
    for (int k = 0; k < 300; ++k) {
      const auto seen = seen_from(X_WC);
      Eigen::Matrix<double, 2 * point_count, 6> L;
      Eigen::Vector<double, 2 * point_count> e;
      for (std::size_t i = 0; i < point_count; ++i) {
        now[i] = feature_of(seen[i]);
        const auto row = static_cast<Eigen::Index>(2 * i);
        L.middleRows<2>(row) = point_interaction(unit_lens, seen[i]).value();
        e.segment<2>(row) = unit_lens.project(seen[i]).value() - unit_lens.project(goal[i]).value();
      }
      const vpColVector theirs = task.computeControlLaw();
      const Eigen::Vector<double, 6> ours = -gain * L.completeOrthogonalDecomposition().solve(e);
      for (unsigned int i = 0; i < 6; ++i) {
        EXPECT_NEAR(ours[i], theirs[i], 1e-9);
        apart = std::max(apart, std::abs(ours[i] - theirs[i]));
      }
      X_WC.position += X_WC.rotation * ours.head<3>() * dt;
      X_WC.rotation = (X_WC.rotation * so3_exp(ours.tail<3>() * dt)).eval();
    }
    EXPECT_LE((X_WC.position - desired.position).norm(), 1e-4);
    EXPECT_LE(so3_log(X_WC.rotation).norm(), 1e-4);
  });
  std::printf("largest difference of a velocity from vpServo's: %.1e\n", apart);
}

}  // namespace
}  // namespace flexura
