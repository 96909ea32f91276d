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
    EXPECT_EQ(none.e_theta, 0);
    EXPECT_EQ(none.e_q, 0);
    EXPECT_NEAR(none.theta, theta, 1e-12);
    EXPECT_NEAR(none.q, q, 1e-9);
  });
}

TEST(PlaneErrors, TellNothingWithin10DegreesOfTheQuarterTurn) {
  const auto determines = [](double theta, double theta_d) {
    return planes_determine({theta * degree, 20 * degree}, {theta_d * degree, 0});
  };
  EXPECT_TRUE(determines(79.9, 0));
  EXPECT_FALSE(determines(80.1, 0));
  EXPECT_FALSE(determines(0, 89));
  EXPECT_FALSE(determines(-95, -120));
  EXPECT_TRUE(determines(120, 120));
}

}  // namespace
}  // namespace flexura
