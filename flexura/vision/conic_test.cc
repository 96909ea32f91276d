#include "flexura/vision/conic.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

double normal_noise(TestRandom& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform(0, 1);
  return sum;
}

/// The image of a circle of radius 1 from a distance of 5 at focal length 1000, with the camera rotated
/// around it by `tilt`.
std::vector<Vector2d> orbit_picture(double tilt, double from, double to, int count) {
  std::vector<Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double phi = from + (to - from) * i / count;
    const double x = std::cos(phi), y = std::sin(phi);
    const double depth = 5 + y * std::sin(tilt);
    points.emplace_back(1000 * x / depth, 1000 * y * std::cos(tilt) / depth);
  }
  return points;
}

TEST(Circle, IsFoundWithItsCovariance) {
  for_random_cases(20, [](TestRandom& random) {
    const Vector2d center = random.vector<2>(-300, 300);
    const double radius = random.uniform(20, 400), from = random.uniform(0, 6), arc = random.uniform(1, 6.2);
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    constexpr int trials = 60;
    for (int k = 0; k < trials; ++k) {
      std::vector<Vector2d> points;
      for (int i = 0; i < 80; ++i) {
        const double phi = from + arc * i / 79, r = radius + 0.1 * normal_noise(random);
        points.emplace_back(center + r * Vector2d(std::cos(phi), std::sin(phi)));
      }
      const auto fit = fit_circle(points, 0.1);
      ASSERT_TRUE(fit);
      EXPECT_NEAR(fit->arc, arc, 0.15);
      const Eigen::Vector3d miss(fit->center.x() - center.x(), fit->center.y() - center.y(),
                                 fit->radius - radius);
      squares += miss.cwiseAbs2() / trials;
      covariance = fit->covariance;
    }
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(squares[i] / covariance(i, i), 1, 0.75) << i;
  });
}

// An arm that hangs straight is an arc of a very large circle; beyond 1e4 times its own size it counts as a
// line.
TEST(Circle, OfAFlatArcHasItsCurvatureAndHowSure) {
  for (const double ratio : {100.0, 1000.0, 3000.0, 4000.0}) {
    int found = 0, cases = 0, within = 0;
    for_random_cases(100, [&](TestRandom& random) {
      const double size = 173, radius = ratio * size, from = random.uniform(0, 6);
      std::vector<Vector2d> points;
      for (int i = 0; i < 200; ++i) {
        const double phi = from + 2 / ratio * i / 199, r = radius + 0.02 * normal_noise(random);
        points.emplace_back(r * Vector2d(std::cos(phi), std::sin(phi)));
      }
      ++cases;
      const auto fit = fit_circle(points, 0.02);
      if (!fit) return;
      ++found;
      for (int i = 0; i < 3; ++i) EXPECT_GT(fit->covariance(i, i), 0) << ratio;
      // The errors of the curvature are normal, those of the radius are not.
      const double sigma = std::sqrt(fit->covariance(2, 2)) / (fit->radius * fit->radius);
      if (std::abs(1 / fit->radius - 1 / radius) < 2 * sigma) ++within;
    });
    EXPECT_GE(found, 0.9 * cases) << ratio;
    EXPECT_GE(within, 0.8 * found) << ratio;
  }
}

TEST(Circle, OfAnOrbitingCameraIsOffByWhatGeometrySays) {
  for (const auto& [degrees, worst] : {std::pair{1.0, 0.015}, {5.0, 0.37}, {10.0, 1.49}}) {
    const auto points = orbit_picture(degrees * pi / 180, 0, 2 * pi, 720);
    const auto fit = fit_circle(points);
    ASSERT_TRUE(fit);
    double largest = 0;
    for (const Vector2d& point : points)
      largest = std::max(largest, std::abs((point - fit->center).norm() - fit->radius));
    EXPECT_NEAR(largest, worst, 0.03 * worst + 0.001);
  }
  const auto arc = orbit_picture(10 * pi / 180, 0, pi / 6, 60);
  const auto fit = fit_circle(arc);
  ASSERT_TRUE(fit);
  double largest = 0;
  for (const Vector2d& point : arc)
    largest = std::max(largest, std::abs((point - fit->center).norm() - fit->radius));
  EXPECT_LT(largest, 0.02);  // Nothing is left of 10 degrees of tilt.
}

TEST(Circle, TestSeesTheTiltThatItSaysItSeesAndLittleLess) {
  TestRandom random(5);
  for (const double arc : {2 * pi, pi, pi / 2}) {
    const auto seen = [&](double tilt, int trials) {
      int count = 0;
      for (int k = 0; k < trials; ++k) {
        auto points = orbit_picture(tilt, 0.3, 0.3 + arc, 200);
        for (Vector2d& point : points) point += 0.1 * Vector2d(normal_noise(random), normal_noise(random));
        count += fit_circle(points, 0.1)->is_verified ? 0 : 1;
      }
      return static_cast<double>(count) / trials;
    };
    const double tilt = fit_circle(orbit_picture(0, 0.3, 0.3 + arc, 200), 0.1)->detectable_tilt;
    EXPECT_GT(seen(tilt, 200), 0.8) << arc;
    EXPECT_LT(seen(0, 400), 0.04) << arc;
    EXPECT_LT(seen(0.3 * tilt, 200), 0.3) << arc;
  }
  EXPECT_GT(fit_circle(orbit_picture(0, 0, pi / 6, 200), 0.1)->detectable_tilt, 0.3);
}

// The test with the points' own residuals (docs/calibration-paper.md, "Convergence"), for a second
// harmonic of rms h among others of rms m. It accepts up to h^2 = 9.21/(n - 12.21) m^2. With 12 points or
// fewer everything is accepted.
TEST(Circle, IsVerifiedUpToTheShareOfASecondHarmonic) {
  const auto is_verified = [](int count, double phase, double second, double fourth) {
    std::vector<Vector2d> points;
    for (int i = 0; i < count; ++i) {
      const double phi = 2 * pi * i / count;
      const double radius =
          150 + std::numbers::sqrt2 * (second * std::cos(2 * (phi - phase)) + fourth * std::cos(4 * phi));
      points.emplace_back(radius * std::cos(phi), radius * std::sin(phi));
    }
    return fit_circle(points)->is_verified;
  };
  for_random_cases(100, [&](TestRandom& random) {
    const int count = random.integer(15, 300);
    const double phase = random.uniform(0, pi), others = random.uniform(0.01, 0.1);
    const double boundary = others * std::sqrt(9.21 / (count - 12.21));
    EXPECT_TRUE(is_verified(count, phase, 0.97 * boundary, others)) << count;
    EXPECT_FALSE(is_verified(count, phase, 1.03 * boundary, others)) << count;
    EXPECT_TRUE(is_verified(random.integer(6, 12), phase, random.uniform(0.01, 1), 0));
  });
}

TEST(Ellipse, IsFoundWithItsCovariance) {
  for_random_cases(20, [](TestRandom& random) {
    EllipseFit truth;
    truth.center = random.vector<2>(0, 600);
    truth.semi_axes = {random.uniform(60, 300), random.uniform(20, 55)};
    truth.angle = random.uniform(-1.5, 1.5);
    Eigen::Matrix<double, 5, 1> squares = Eigen::Matrix<double, 5, 1>::Zero();
    Eigen::Matrix<double, 5, 5> covariance;
    constexpr int trials = 60;
    for (int k = 0; k < trials; ++k) {
      std::vector<Vector2d> points;
      for (int i = 0; i < 150; ++i) {
        const double t = 2 * pi * i / 150;
        const Vector2d local(truth.semi_axes.x() * std::cos(t), truth.semi_axes.y() * std::sin(t));
        const Vector2d point = truth.center + Eigen::Rotation2Dd(truth.angle) * local;
        points.emplace_back(point + 0.1 * Vector2d(normal_noise(random), normal_noise(random)));
      }
      const auto fit = fit_ellipse(points);
      ASSERT_TRUE(fit);
      EXPECT_NEAR(fit->rms, 0.1, 0.03);
      Eigen::Matrix<double, 5, 1> miss;
      miss << fit->center - truth.center, fit->semi_axes - truth.semi_axes, fit->angle - truth.angle;
      squares += miss.cwiseAbs2() / trials;
      covariance = fit->covariance;
    }
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(squares[i] / covariance(i, i), 1, 0.75) << i;
  });
}

TEST(Ellipse, DistanceIsToTheNearestPoint) {
  for_random_cases(50, [](TestRandom& random) {
    EllipseFit ellipse;
    ellipse.semi_axes = {random.uniform(10, 50), random.uniform(2, 10)};
    ellipse.angle = random.uniform(-1.5, 1.5);
    const Vector2d point = random.vector<2>(-60, 60);
    double nearest = 1e9;
    for (int i = 0; i < 20000; ++i) {
      const double t = 2 * pi * i / 20000;
      const Vector2d local(ellipse.semi_axes.x() * std::cos(t), ellipse.semi_axes.y() * std::sin(t));
      nearest = std::min(nearest, (Eigen::Rotation2Dd(ellipse.angle) * local - point).norm());
    }
    EXPECT_NEAR(std::abs(distance_to(ellipse, point)), nearest, 1e-3);
  });
}

TEST(Circle, OfFewPointsProvesNothing) {
  const auto fit = fit_circle(std::vector<Vector2d>{{0, 0}, {10, 0}, {3, 8}});
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->is_verified);
  EXPECT_DOUBLE_EQ(fit->detectable_tilt, 0.5 * std::numbers::pi);
}

TEST(Conics, OfTooFewPointsOrALineAreNone) {
  const std::vector<Vector2d> line = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {6, 6}};
  EXPECT_FALSE(fit_circle(line));
  EXPECT_FALSE(fit_ellipse(line));
  EXPECT_FALSE(fit_circle(std::vector<Vector2d>{{0, 0}, {1, 0}}));
  EXPECT_FALSE(fit_ellipse(std::vector<Vector2d>(5, Vector2d(1, 2))));
}

}  // namespace
}  // namespace flexura
