#include "flexura/math/quadrature.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace flexura {
namespace {

TEST(Quadrature, IsExactForPolynomialsUpToItsDegreeAndNotBeyond) {
  for (const int points : {1, 2, 5, 10, 20}) {
    const Quadrature rule = gauss_legendre(points);
    const auto monomial_integral = [&](int degree) {
      return integrate(rule, [degree](double x) { return std::pow(x, degree); }, 0.0, 1.0);
    };
    const int top = 2 * points - 1;
    EXPECT_NEAR(monomial_integral(top), 1.0 / (top + 1), 1e-15);
    if (points <= 5) {
      EXPECT_GT(std::abs(monomial_integral(top + 1) - 1.0 / (top + 2)), 1e-8);
    }
  }
}

TEST(Quadrature, OfLobattoHasTheEndsAndIsExactUpToItsDegree) {
  for (const int points : {2, 3, 4, 6, 11, 20}) {
    const Quadrature rule = gauss_lobatto(points);
    EXPECT_EQ(rule.nodes.front(), -1);
    EXPECT_EQ(rule.nodes.back(), 1);
    const auto monomial_integral = [&](int degree) {
      return integrate(rule, [degree](double x) { return std::pow(x, degree); }, 0.0, 1.0);
    };
    const int top = 2 * points - 3;
    EXPECT_NEAR(monomial_integral(top), 1.0 / (top + 1), 1e-15);
    if (points <= 6) {
      EXPECT_GT(std::abs(monomial_integral(top + 1) - 1.0 / (top + 2)), 1e-8);
    }
  }
  EXPECT_THROW(gauss_lobatto(1), std::invalid_argument);
}

TEST(Quadrature, PolynomialsOfLegendreAreSquareToEachOther) {
  const Quadrature rule = gauss_legendre(12);
  for (int m = 0; m < 10; ++m) {
    EXPECT_EQ(legendre(m, 1), 1);
    EXPECT_DOUBLE_EQ(legendre_slope(m, 1), m * (m + 1) / 2.0);
    EXPECT_NEAR(legendre_slope(m, 0.3), (legendre(m, 0.3 + 1e-6) - legendre(m, 0.3 - 1e-6)) / 2e-6, 1e-8);
    for (int n = 0; n < 10; ++n) {
      const double product =
          integrate(rule, [&](double x) { return legendre(m, x) * legendre(n, x); }, -1.0, 1.0);
      EXPECT_NEAR(product, m == n ? 2.0 / (2 * n + 1) : 0, 1e-14);
    }
  }
}

TEST(Quadrature, IntegratesVectorsOverPanels) {
  const Quadrature rule = gauss_legendre(10);
  const auto circle = [](double t) { return Eigen::Vector2d(std::cos(t), std::sin(t)); };
  const Eigen::Vector2d integral = integrate(rule, circle, 0.0, 7.0, 4);
  EXPECT_NEAR(integral.x(), std::sin(7.0), 1e-14);
  EXPECT_NEAR(integral.y(), 1.0 - std::cos(7.0), 1e-14);
}

TEST(Quadrature, RefusesARuleWithoutPoints) { EXPECT_THROW((void)gauss_legendre(0), std::invalid_argument); }

}  // namespace
}  // namespace flexura
