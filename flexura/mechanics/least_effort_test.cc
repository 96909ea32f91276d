#include "flexura/mechanics/least_effort.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(LeastEffort, TheLeastInABoxPressesOnlyAgainstItsSides) {
  for_random_cases(300, [](TestRandom& random) {
    const int count = random.integer(1, 8);
    Eigen::MatrixXd root(count, count);
    Eigen::VectorXd b(count), low(count), high(count);
    for (double& value : root.reshaped()) value = random.uniform(-1, 1);
    for (int i = 0; i < count; ++i) {
      b[i] = random.uniform(-2, 2);
      low[i] = random.integer(0, 2) == 0 ? 0 : random.uniform(-1, 0);
      high[i] = random.integer(0, 2) == 0 ? 0 : random.uniform(0, 1);
    }
    const Eigen::MatrixXd A = root * root.transpose() + 1e-3 * Eigen::MatrixXd::Identity(count, count);
    const Eigen::VectorXd d = least_in_box(A, b, low, high), slope = A * d + b;
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(d[i] >= low[i] && d[i] <= high[i]);
      EXPECT_TRUE(d[i] == low[i] || slope[i] <= 1e-9) << i;
      EXPECT_TRUE(d[i] == high[i] || slope[i] >= -1e-9) << i;
    }
  });
}

// x on a sphere: the point nearest to 0 is known.
class OnASphere final : public BoundedProblem {
 public:
  [[nodiscard]] Eigen::Index row_count() const override { return 1; }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override {
    const Eigen::VectorXd off = x - middle;
    r[0] = 0.5 * (off.squaredNorm() - radius * radius);
    J = off.transpose();
  }
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override { return std::abs(r[0]) < 1e-12; }

  Eigen::VectorXd middle;
  double radius = 1;
};

TEST(LeastEffort, OfASphereTheNearestPointIsFound) {
  for_random_cases(100, [](TestRandom& random) {
    OnASphere sphere;
    sphere.middle = random.vector<4>(0.5, 1.0);
    // The sphere does not contain 0; its curvature is more or less than that of |x|^2.
    sphere.radius = random.uniform(0.1, 0.9) * sphere.middle.norm();
    Bounds bounds;
    for (Eigen::Index i = 0; i < 4; ++i) bounds.push_back(Bound::interval(i, 0, 3));
    BoundedDescent descent(sphere, bounds, 4);
    // From behind the centre the search may end at a corner of the bounds instead.
    Eigen::VectorXd x = 0.5 * sphere.middle + 0.3 * random.vector<4>(-1.0, 1.0);
    project(bounds, x);
    ASSERT_EQ(descent.descend({}, x), Descent::met);
    ASSERT_TRUE(run_down_to_least(descent, x));
    const Eigen::VectorXd nearest = (1 - sphere.radius / sphere.middle.norm()) * sphere.middle;
    EXPECT_LE((x - nearest).norm(), 1e-5);
  });
}

}  // namespace
}  // namespace flexura
