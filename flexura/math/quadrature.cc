#include "flexura/math/quadrature.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace flexura {
namespace {

// Values of P_n and P_(n-1) at x.
struct LegendrePair {
  double value;
  double before;
};

// Computes P_n and P_(n-1) at x by the three-term recurrence.
LegendrePair legendre_pair(int n, double x) {
  if (n == 0) return {1, 0};
  double before = 1.0;
  double value = x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
    before = value;
    value = next;
  }
  return {value, before};
}

// Returns P_n' at x in (-1, 1).
double inner_slope(int n, double x) {
  const LegendrePair p = legendre_pair(n, x);
  return n * (p.before - x * p.value) / (1.0 - x * x);
}

}  // namespace

Quadrature gauss_legendre(int points) {
  if (points < 1) {
    throw std::invalid_argument("a Gauss-Legendre rule cannot have " + std::to_string(points) + " points");
  }
  Quadrature rule;
  for (int i = points; i >= 1; --i) {
    // Newton's method, started from Tricomi's estimate of the root, converges in a few steps.
    double x = std::cos(std::numbers::pi * (i - 0.25) / (points + 0.5));
    for (int step = 0; step < 6; ++step) {
      x -= legendre_pair(points, x).value / inner_slope(points, x);
    }
    const double slope = inner_slope(points, x);
    rule.nodes.push_back(x);
    rule.weights.push_back(2.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

Quadrature gauss_lobatto(int points) {
  if (points < 2) {
    throw std::invalid_argument("a Gauss-Lobatto rule cannot have " + std::to_string(points) + " points");
  }
  // The inner nodes are the roots of P_n', with n = points - 1.
  const int n = points - 1;
  Quadrature rule;
  for (int i = n; i >= 0; --i) {
    double x = std::cos(std::numbers::pi * i / n);
    for (int step = 0; step < 8 && i > 0 && i < n; ++step) {
      // P_n'' from Legendre's differential equation.
      const double slope = inner_slope(n, x), value = legendre_pair(n, x).value;
      x -= slope * (1 - x * x) / (2 * x * slope - n * (n + 1) * value);
    }
    const double value = legendre_pair(n, x).value;
    rule.nodes.push_back(x);
    rule.weights.push_back(2.0 / (n * (n + 1) * value * value));
  }
  return rule;
}

double legendre(int degree, double x) { return legendre_pair(degree, x).value; }

double legendre_slope(int degree, double x) {
  // P_n' = n P_(n-1) + x P_(n-1)'.
  double slope = 0;
  for (int n = 1; n <= degree; ++n) slope = n * legendre(n - 1, x) + x * slope;
  return slope;
}

}  // namespace flexura
