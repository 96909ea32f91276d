#pragma once

#include <cstddef>
#include <vector>

namespace flexura {

/// Nodes and weights of a rule on [-1, 1].
struct Quadrature {
  std::vector<double> nodes;    ///< Rising, within [-1, 1].
  std::vector<double> weights;  ///< One a node; their sum is 2.
};

/// The Gauss-Legendre rule of `points` >= 1 nodes, exact for polynomials of degree 2 points - 1;
/// std::invalid_argument for fewer than one.
[[nodiscard]] Quadrature gauss_legendre(int points);

/// The Gauss-Lobatto rule of `points` >= 2 nodes, the ends among them, exact for polynomials of degree 2
/// points - 3; std::invalid_argument for fewer than two.
[[nodiscard]] Quadrature gauss_lobatto(int points);

/// P_degree(x) of Legendre, for x in [-1, 1].
[[nodiscard]] double legendre(int degree, double x);
/// Its derivative by x.
[[nodiscard]] double legendre_slope(int degree, double x);

/// The integral of f over [a, b], cut into `panels` >= 1 equal parts with `rule` in each. f takes a double
/// and returns a double or an Eigen vector or matrix (by value, never an expression of temporaries).
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
