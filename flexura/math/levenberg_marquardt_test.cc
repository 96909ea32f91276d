#include "flexura/math/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>

namespace flexura {
namespace {

// H. H. Rosenbrock's valley: r = (10 (y - x^2), 1 - x).
struct Valley {
  Eigen::Vector2d x{-1.2, 1}, there{0, 0};
  int kept = 0, most_kept = 1000;
  static Eigen::Vector2d residual(const Eigen::Vector2d& x) {
    return {10 * (x.y() - x.x() * x.x()), 1 - x.x()};
  }
  DescentEnd descend(int most_tries) {
    const auto try_step = [&](double damping) -> TriedStep {
      Eigen::Matrix2d J;
      J << -20 * x.x(), 10, -1, 0;
      const Eigen::Vector2d r = residual(x), gradient = J.transpose() * r;
      const Eigen::Matrix2d damped = J.transpose() * J + damping * Eigen::Matrix2d::Identity();
      const Eigen::Vector2d step = -damped.inverse() * gradient;
      there = x + step;
      return {residual(there).squaredNorm(), r.squaredNorm() - (r + J * step).squaredNorm()};
    };
    const auto keep = [&](const TriedStep& step, double& cost) {
      EXPECT_LT(step.cost, cost);
      x = there, cost = step.cost;
      return ++kept == most_kept;
    };
    const auto leave = [](const TriedStep& step, double cost) {
      EXPECT_FALSE(step.cost < cost);
      return false;
    };
    const auto eased = [](double damping, double ratio) { return ratio > 0.5 ? 0.1 * damping : damping; };
    return levenberg_marquardt(residual(x).squaredNorm(), {.eased = eased}, most_tries, try_step, keep,
                               leave);
  }
};

TEST(LevenbergMarquardt, GoesDownToWhereNoStepLeads) {
  Valley valley;
  EXPECT_EQ(valley.descend(1000), DescentEnd::stuck);
  EXPECT_LT((valley.x - Eigen::Vector2d(1, 1)).norm(), 1e-12);
  EXPECT_LT(valley.kept, 40);
}

TEST(LevenbergMarquardt, EndsWhereItIsToEnd) {
  Valley few, done{.most_kept = 3};
  EXPECT_EQ(few.descend(5), DescentEnd::exhausted);
  EXPECT_EQ(done.descend(1000), DescentEnd::done);
  EXPECT_EQ(done.kept, 3);
}

}  // namespace
}  // namespace flexura
