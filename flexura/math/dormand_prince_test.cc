#include "flexura/math/dormand_prince.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace flexura {
namespace {

// A pendulum with a large swing: its energy is known, and the time of a quarter of its period.
void pendulum(double, const Eigen::VectorXd& y, Eigen::VectorXd& slope) {
  slope[0] = y[1];
  slope[1] = -std::sin(y[0]);
}

TEST(DormandPrince, SwingsAPendulumInTheTimeOfItsEllipticIntegral) {
  // From rest at 2 rad to the lowest point: K(sin 1).
  DormandPrince ode(2, {.relative = 1e-12, .absolute = 1e-14});
  double t = 0;
  Eigen::VectorXd y(2);
  y << 2, 0;
  const double quarter = std::comp_ellint_1(std::sin(1.0));
  ASSERT_TRUE(ode.advance(pendulum, t, y, quarter).is_there);
  EXPECT_EQ(t, quarter);
  EXPECT_NEAR(y[0], 0, 1e-10);
  EXPECT_NEAR(y[1], -2 * std::sin(1.0), 1e-10);
}

TEST(DormandPrince, IsOfFifthOrder) {
  const auto error = [](int steps) {
    // The steps have the largest allowed size: none is rejected.
    DormandPrince ode(2,
                      {.relative = 1, .absolute = 1, .first_step = 2.0 / steps, .largest_step = 2.0 / steps});
    double t = 0;
    Eigen::VectorXd y(2);
    y << 0, 1;
    const auto turn = [](double, const Eigen::VectorXd& at, Eigen::VectorXd& slope) {
      slope[0] = at[1];
      slope[1] = -at[0];
    };
    EXPECT_EQ(ode.advance(turn, t, y, 2.0).steps, steps);
    return std::hypot(y[0] - std::sin(2.0), y[1] - std::cos(2.0));
  };
  EXPECT_NEAR(std::log2(error(16) / error(32)), 5, 0.3);
}

TEST(DormandPrince, EndsWhereItCannotGoOn) {
  // y' = y^2 from 1 goes to infinity at t = 1.
  const auto f = [](double, const Eigen::VectorXd& y, Eigen::VectorXd& slope) { slope[0] = y[0] * y[0]; };
  DormandPrince ode(1, {.most_steps = 10000});
  double t = 0;
  Eigen::VectorXd y = Eigen::VectorXd::Ones(1);
  EXPECT_FALSE(ode.advance(f, t, y, 2.0).is_there);
  EXPECT_NEAR(t, 1, 1e-6);
  const auto none = [](double, const Eigen::VectorXd&, Eigen::VectorXd& slope) {
    slope[0] = std::numeric_limits<double>::quiet_NaN();
  };
  DormandPrince lost(1, {.most_steps = 2000});
  t = 0, y[0] = 1;
  EXPECT_FALSE(lost.advance(none, t, y, 1.0).is_there);
  EXPECT_EQ(y[0], 1);
}

TEST(DormandPrince, EndsBetweenTwoStepsWhereItIsTold) {
  const auto fall = [](double, const Eigen::VectorXd& y, Eigen::VectorXd& slope) { slope = -y; };
  DormandPrince ode(1, {.largest_step = 0.01});
  double t = 0;
  Eigen::VectorXd y = Eigen::VectorXd::Ones(1);
  int asked = 0;
  const auto progress = ode.advance(fall, t, y, 1.0, [&] { return ++asked <= 5; });
  EXPECT_FALSE(progress.is_there);
  EXPECT_EQ(progress.steps, 5);
  EXPECT_GT(t, 0);
  EXPECT_LE(t, 0.05 + 1e-12);
  EXPECT_NEAR(y[0], std::exp(-t), 1e-9);
  EXPECT_TRUE(ode.advance(fall, t, y, 1.0).is_there);  // It continues from there.
  EXPECT_NEAR(y[0], std::exp(-1), 1e-9);
}

}  // namespace
}  // namespace flexura
