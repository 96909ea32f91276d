#include "flexura/math/monotone_cubic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "flexura/math/derivative_check.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

struct Points {
  std::vector<double> x, y;
};

Points random_points(TestRandom& random) {
  Points points;
  double x = random.uniform(-5, 5);
  for (int count = random.integer(2, 8); count > 0; --count) {
    points.x.push_back(x += std::pow(10.0, random.uniform(-2, 1)));
    points.y.push_back(random.integer(0, 4) == 0 && !points.y.empty() ? points.y.back()
                                                                      : random.uniform(-3, 3));
  }
  return points;
}

TEST(MonotoneCubic, PassesThroughItsPointsAndStaysBetweenThem) {
  for_random_cases(300, [](TestRandom& random) {
    const auto [x, y] = random_points(random);
    const MonotoneCubic curve(x, y);
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_NEAR(curve.value(x[i]), y[i], 1e-14 * (1 + std::abs(y[i])));
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      const double sense = y[i + 1] >= y[i] ? 1 : -1;
      double last = y[i];
      for (int k = 1; k <= 50; ++k) {
        const double now = curve.value(x[i] + (x[i + 1] - x[i]) * k / 50);
        EXPECT_GE(sense * (now - last), -1e-14);
        last = now;
      }
    }
  });
}

TEST(MonotoneCubic, ItsSlopeIsItsDerivativeAndContinuous) {
  for_random_cases(300, [](TestRandom& random) {
    const auto [x, y] = random_points(random);
    const MonotoneCubic curve(x, y);
    const auto value = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, curve.value(at[0]));
    };
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      const double width = x[i + 1] - x[i];
      const double at = x[i] + width * random.uniform(0.1, 0.9);
      const auto numeric = numerical_jacobian(value, Eigen::VectorXd::Constant(1, at), 0.09 * width);
      EXPECT_NEAR(curve.slope(at), numeric.value(0, 0), 1e-9 * (1 + 6 / width));
      if (i == 0) continue;
      const double step = 1e-9 * std::min(width, x[i] - x[i - 1]);
      EXPECT_NEAR(curve.slope(x[i] - step), curve.slope(x[i] + step),
                  1e-6 * (1 + 6 / width + 6 / (x[i] - x[i - 1])));
    }
  });
}

// Away from points where the slopes' rule is not smooth.
TEST(MonotoneCubic, FollowsEachOfItsPointsAsItSays) {
  for_random_cases(100, [](TestRandom& random) {
    std::vector<double> x = {random.uniform(-5, 5)}, y = {random.uniform(-3, 3)};
    for (int count = random.integer(1, 6); count > 0; --count) {
      x.push_back(x.back() + random.uniform(0.5, 1.5));
      // Rising, falling, and turning; never nearly level, nor near the limit of an end's slope.
      const double rise = random.uniform(0.7, 1) * (x.back() - x[x.size() - 2]);
      y.push_back(y.back() + (random.integer(0, 3) == 0 ? -rise : rise));
    }
    const MonotoneCubic curve(x, y);
    const double at = random.uniform(x.front(), x.back());
    const auto value = [&](const Eigen::VectorXd& points) -> Eigen::VectorXd {
      const std::vector<double> moved(points.begin(), points.end());
      return Eigen::VectorXd::Constant(1, MonotoneCubic(x, moved).value(at));
    };
    const auto numeric = numerical_jacobian(
        value, Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size())), 0.02);
    for (std::size_t i = 0; i < y.size(); ++i)
      EXPECT_NEAR(curve.by_point(at, i), numeric.value(0, static_cast<Eigen::Index>(i)), 1e-8)
          << at << ' ' << i;
  });
}

TEST(MonotoneCubic, DrawsALineThroughPointsOfALine) {
  const MonotoneCubic line({-1, 0.5, 0.7, 4}, {-2, 1, 1.4, 8});
  for (double x = -1; x <= 4; x += 0.01) {
    EXPECT_NEAR(line.value(x), 2 * x, 1e-14);
    EXPECT_NEAR(line.slope(x), 2, 1e-13);
  }
}

TEST(MonotoneCubic, StaysAtItsEndsOutside) {
  const MonotoneCubic curve({0, 1, 2}, {1, 3, 4});
  EXPECT_EQ(curve.value(-7), 1);
  EXPECT_EQ(curve.value(9), 4);
  EXPECT_EQ(curve.slope(-7), 0);
  EXPECT_EQ(curve.slope(9), 0);
  EXPECT_EQ(MonotoneCubic({2}, {5}).value(2), 5);
  EXPECT_EQ(MonotoneCubic({2}, {5}).slope(2), 0);
}

TEST(MonotoneCubic, RefusesWhatIsNoCurve) {
  EXPECT_THROW(MonotoneCubic({}, {}), std::invalid_argument);
  EXPECT_THROW(MonotoneCubic({0, 1}, {1}), std::invalid_argument);
  EXPECT_THROW(MonotoneCubic({0, 0}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(MonotoneCubic({0, 1}, {1, std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
