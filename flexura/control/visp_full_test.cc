#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/control/interaction.h"
#include "flexura/math/pose.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"
#include "tests/support/visp_peer.h"

namespace flexura {
namespace {

Lens unit_lens() { return Lens({.fx = 1, .fy = 1, .cx = 0, .cy = 0}); }

VispPoint visp_point(const Eigen::Vector3d& p_CP) {
  return {p_CP.x() / p_CP.z(), p_CP.y() / p_CP.z(), p_CP.z()};
}

TEST(AgainstViSP, APointsInteractionMatrixIsTheSame) {
  for_random_cases(200, [](TestRandom& random) {
    const Eigen::Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.3, 5));
    const std::array<double, 12> theirs = visp_interaction(visp_point(p));
    const auto ours = point_interaction(unit_lens(), p).value();
    for (std::size_t i = 0; i < 12; ++i)
      EXPECT_NEAR(ours(static_cast<Eigen::Index>(i / 6), static_cast<Eigen::Index>(i % 6)), theirs[i],
                  1e-13 * (1 + ours.norm()));
  });
}

// The corners of a square and a point above its middle, before a camera at X_WC.
std::vector<Eigen::Vector3d> seen_from(const Pose& X_WC) {
  std::vector<Eigen::Vector3d> places = {
      {-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}, {0, 0, 0.05}};
  for (Eigen::Vector3d& place : places) place = X_WC.inverse() * place;
  return places;
}

std::vector<VispPoint> visp_points(const std::vector<Eigen::Vector3d>& seen) {
  std::vector<VispPoint> points;
  points.reserve(seen.size());
  for (const Eigen::Vector3d& p_CP : seen) points.push_back(visp_point(p_CP));
  return points;
}

TEST(AgainstViSP, AFreeCameraServosAlike) {
  double apart = 0;
  for_random_cases(20, [&](TestRandom& random) {
    constexpr double gain = 0.8, dt = 0.05;
    const Pose desired{Eigen::Matrix3d::Identity(), {0, 0, -1}};
    const Lens lens = unit_lens();
    Pose X_WC{so3_exp(random.vector<3>(-0.25, 0.25)),
              Eigen::Vector3d(0, 0, -1) + random.vector<3>(-0.2, 0.2)};
    const std::vector<Eigen::Vector3d> goal = seen_from(desired);
    for (int k = 0; k < 300; ++k) {
      const std::vector<Eigen::Vector3d> seen = seen_from(X_WC);
      Eigen::Matrix<double, 10, 6> L;
      Eigen::Vector<double, 10> e;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(2 * i);
        L.middleRows<2>(row) = point_interaction(lens, seen[i]).value();
        e.segment<2>(row) = lens.project(seen[i]).value() - lens.project(goal[i]).value();
      }
      const std::array<double, 6> theirs = visp_velocity(visp_points(seen), visp_points(goal), gain);
      const Eigen::Vector<double, 6> ours = -gain * L.completeOrthogonalDecomposition().solve(e);
      for (std::size_t i = 0; i < 6; ++i) {
        const double off = std::abs(ours[static_cast<Eigen::Index>(i)] - theirs[i]);
        EXPECT_LE(off, 1e-9);
        apart = std::max(apart, off);
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
