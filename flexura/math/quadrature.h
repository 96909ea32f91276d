#pragma once

#include <cstddef>
#include <vector>

namespace flexura {

/// Nodes and weights of a quadrature rule on [-1, 1].
struct Quadrature {
  std::vector<double> nodes;    ///< Increasing nodes in [-1, 1].
  std::vector<double> weights;  ///< One weight per node; the sum of the weights is 2.
};

/// Returns the Gauss-Legendre rule with `points` nodes, exact for polynomials up to degree 2 points - 1.
/// Throws std::invalid_argument for points < 1.
[[nodiscard]] Quadrature gauss_legendre(int points);

/// Returns the Gauss-Lobatto rule with `points` nodes, which include both ends, exact for polynomials up to
/// degree 2 points - 3. Throws std::invalid_argument for points < 2.
[[nodiscard]] Quadrature gauss_lobatto(int points);

/// Returns the Legendre polynomial P_degree(x), for x in [-1, 1].
[[nodiscard]] double legendre(int degree, double x);
/// Returns the derivative of the Legendre polynomial P_degree at x.
[[nodiscard]] double legendre_slope(int degree, double x);

/// Returns the integral of f over [a, b], with `rule` applied to each of `panels` >= 1 equal parts. The
/// function f takes a double. f returns a double, or an Eigen vector or matrix by value (not an Eigen
/// expression).
template <typename Function>
[[nodiscard]] auto integrate(const Quadrature& rule, Function&& f, double a, double b, int panels = 1) {
  const double half = 0.5 * (b - a) / panels;
  decltype(f(a)) sum = 0.0 * f(a);
  for (int panel = 0; panel < panels; ++panel) {
    const double middle = a + (2 * panel + 1) * half;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      sum += half * rule.weights[i] * f(middle + half * rule.nodes[i]);
    }
  }
  return sum;
}

}  // namespace flexura
