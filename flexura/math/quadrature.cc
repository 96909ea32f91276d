#include "flexura/math/quadrature.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace flexura {
namespace {

struct Legendre {
  double value;
  double slope;
};

// P_n and P_n' at x in (-1, 1), by the three-term recurrence.
Legendre legendre(int n, double x) {
  double before = 1.0;
  double value = x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
    before = value;
    value = next;
  }
  return {value, n * (before - x * value) / (1.0 - x * x)};
}

}  // namespace

Quadrature gauss_legendre(int points) {
  if (points < 1) {
    throw std::invalid_argument("a Gauss-Legendre rule cannot have " + std::to_string(points) + " points");
  }
  Quadrature rule;
  for (int i = points; i >= 1; --i) {
    // Tricomi's estimate of the root is good enough for Newton's method to settle in a few steps.
    double x = std::cos(std::numbers::pi * (i - 0.25) / (points + 0.5));
    for (int step = 0; step < 6; ++step) {
      const Legendre p = legendre(points, x);
      x -= p.value / p.slope;
    }
    const double slope = legendre(points, x).slope;
    rule.nodes.push_back(x);
    rule.weights.push_back(2.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

}  // namespace flexura
