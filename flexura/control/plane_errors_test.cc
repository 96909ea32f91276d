#include "flexura/control/plane_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "flexura/base/degree.h"
#include "flexura/math/derivative_check.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(PlaneErrors, AreTheDerivativesOfTheViewsReading) {
  for_random_cases(200, [](TestRandom& random) {
    const double theta = random.uniform(-1.3, 1.3), q = random.uniform(-1.3, 1.3);
    const PlaneView view = plane_view(theta, q);
    const Eigen::Vector2d at(view.alpha_1, view.alpha_2);
    const auto reading = numerical_jacobian(
        [](const Eigen::VectorXd& a) -> Eigen::VectorXd {
          return Eigen::VectorXd::Constant(1, std::atan(std::tan(a[1]) * std::cos(a[0])));
        },
        at, 0.01);
    const PlaneView by_1{at[0] - 1, at[1]}, by_2{at[0], at[1] - 1};
    EXPECT_NEAR(plane_error(view, by_1).e_q, reading.value(0, 0), 1e-8);
    EXPECT_NEAR(plane_error(view, by_2).e_q, reading.value(0, 1), 1e-8);
    EXPECT_NEAR(plane_error(view, by_1).e_theta, 1, 1e-15);
    const PlaneError none = plane_error(view, view);
    EXPECT_EQ(none.spatial, 0);
    EXPECT_NEAR(none.theta, theta, 1e-12);
    EXPECT_NEAR(none.q, q, 1e-9);
    EXPECT_NEAR(none.gain, reading.value(0, 0), 1e-8);
    // The spatial error of neighbours is the angle between their directions.
    const double dt = random.uniform(-1e-4, 1e-4), dq = random.uniform(-1e-4, 1e-4);
    const PlaneView near = plane_view(theta + dt, q + dq);
    const auto e = [](double a, double b) {
      return Eigen::Vector3d(std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), std::sin(b));
    };
    const double angle = (e(theta + dt, q + dq) - e(theta, q)).norm();
    EXPECT_NEAR(exact_plane_error(near, view).spatial, angle, 1e-7);
    EXPECT_NEAR(plane_error(near, view).spatial, angle, 5e-7);
  });
}

TEST(PlaneErrors, GrowWithoutBoundTowardsTheQuarterTurn) {
  const auto at = [](double theta) { return plane_error(plane_view(theta * degree, 20 * degree), {}); };
  EXPECT_NEAR(at(30).gain, -0.19, 0.005);
  EXPECT_NEAR(at(80).gain, -1.8, 0.05);
  EXPECT_NEAR(at(89).gain, -18.4, 0.05);
  EXPECT_FALSE(at(79.9).is_singular);
  EXPECT_TRUE(at(80.1).is_singular);
  EXPECT_TRUE(at(-95).is_singular);
  EXPECT_FALSE(at(120).is_singular);
  EXPECT_TRUE(exact_plane_error({0, 0}, plane_view(89 * degree, 0)).is_singular);
}

}  // namespace
}  // namespace flexura
