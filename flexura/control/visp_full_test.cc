#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <vector>

#include "flexura/control/image_law.h"
#include "flexura/math/pose.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_views.h"
#include "tests/support/visp_peer.h"

namespace flexura {
namespace {

VispPoint visp_point(const Eigen::Vector3d& p_CP) {
  return {p_CP.x() / p_CP.z(), p_CP.y() / p_CP.z(), p_CP.z()};
}

// Returns a point's interaction matrix from the literature (F. Chaumette, S. Hutchinson, "Visual servo
// control I", 2006, eq. 11).
Eigen::Matrix<double, 2, 6> point_interaction(const Eigen::Vector3d& p) {
  const double x = p.x() / p.z(), y = p.y() / p.z(), Z = p.z();
  Eigen::Matrix<double, 2, 6> L;
  L << -1 / Z, 0, x / Z, x * y, -(1 + x * x), y, 0, -1 / Z, y / Z, 1 + y * y, -x * y, -x;
  return L;
}

// Returns the corners of a square and a point above its middle, in a camera at X_WC.
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

constexpr double gain = 0.8, dt = 0.05;  // 1/s, s.

// Returns a law's velocity [v; w] for a free camera, m/s and rad/s.
using FreeLaw = std::function<Eigen::Vector<double, 6>(const std::vector<Eigen::Vector3d>& seen,
                                                       const std::vector<Eigen::Vector3d>& goal)>;

FreeLaw of_visp() {
  return [](const auto& seen, const auto& goal) {
    const std::array<double, 6> velocity = VispServo(visp_points(goal), gain).velocity(visp_points(seen));
    return Eigen::Vector<double, 6>(velocity.data());
  };
}

// The servo's law. The six variables of an arm of three sections stand for the camera's motion until the next
// step: the law needs only an error and its Jacobian, of any system. 1 - exp(-rate dt) corresponds to gain
// times dt in vpServo.
FreeLaw of_image_law(double damping) {
  const ImageLaw law(servo_arm(), {.rate = -std::log1p(-gain * dt) / dt, .damping = damping});
  return [law](const auto& seen, const auto& goal) {
    const auto rows = static_cast<Eigen::Index>(2 * seen.size());
    Eigen::MatrixXd L(rows, 6);
    Eigen::VectorXd e(rows);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(2 * i);
      L.middleRows<2>(row) = point_interaction(seen[i]);
      e.segment<2>(row) = seen[i].hnormalized() - goal[i].hnormalized();
    }
    const ImageStep step = law.step(ArmState::straight(3), e, L, dt);
    Eigen::Vector<double, 6> velocity;
    for (std::size_t i = 0; i < 3; ++i)
      velocity.segment<2>(static_cast<Eigen::Index>(2 * i)) = step.asked.bends[i] / dt;
    return velocity;
  };
}

const Pose& desired_pose() {
  static const Pose pose{Eigen::Matrix3d::Identity(), {0, 0, -1}};
  return pose;
}

Pose random_pose(TestRandom& random) {
  return {so3_exp(random.vector<3>(-0.25, 0.25)), Eigen::Vector3d(0, 0, -1) + random.vector<3>(-0.2, 0.2)};
}

Pose moved(const Pose& X_WC, const Eigen::Vector<double, 6>& velocity) {
  return {(X_WC.rotation * so3_exp(velocity.tail<3>() * dt)).eval(),
          X_WC.position + X_WC.rotation * velocity.head<3>() * dt};
}

// In m and rad, the larger.
double apart(const Pose& a, const Pose& b) {
  return std::max((a.position - b.position).norm(), so3_log(a.rotation.transpose() * b.rotation).norm());
}

// Each moves its own camera from the same pose.
TEST(AgainstViSP, TheImageLawBringsAFreeCameraTheSameWay) {
  constexpr int steps = 300;
  int theirs_there = 0, ours_there = 0, damped_there = 0, count = 0;
  double most = 0;
  const FreeLaw theirs = of_visp(), ours = of_image_law(0), damped = of_image_law(ImageLawGains{}.damping);
  for_random_cases(30, [&](TestRandom& random) {
    const std::vector<Eigen::Vector3d> goal = seen_from(desired_pose());
    Pose by_theirs = random_pose(random), by_ours = by_theirs, by_damped = by_theirs;
    for (int k = 0; k < steps; ++k) {
      by_theirs = moved(by_theirs, theirs(seen_from(by_theirs), goal));
      by_ours = moved(by_ours, ours(seen_from(by_ours), goal));
      by_damped = moved(by_damped, damped(seen_from(by_damped), goal));
      most = std::max(most, apart(by_theirs, by_ours));
    }
    constexpr double there = 1e-4;
    ++count;
    theirs_there += apart(by_theirs, desired_pose()) < there ? 1 : 0;
    ours_there += apart(by_ours, desired_pose()) < there ? 1 : 0;
    damped_there += apart(by_damped, desired_pose()) < there ? 1 : 0;
  });
  EXPECT_LE(most, 1e-8);
  EXPECT_EQ(theirs_there, count);
  EXPECT_EQ(ours_there, count);
  EXPECT_EQ(damped_there, count);
  std::printf(
      "of %d free cameras vpServo brought %d, ImageLaw %d, with the servo's damping %d; at most %.1e m or "
      "rad apart\n",
      count, theirs_there, ours_there, damped_there, most);
}

}  // namespace
}  // namespace flexura
