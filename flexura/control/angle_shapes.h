#pragma once

#include <Eigen/Core>
#include <vector>

namespace flexura {

/// Functions of arc length that represent an angle of a distributed arm by finitely many numbers.
enum class AngleBasis {
  polynomial,  ///< One polynomial along the whole arm, given by its values at Gauss-Legendre nodes.
  sections,    ///< Linear in every section, given by its values at the sections' ends (and at the base).
};

/// Points of the unstretched arm for integrals along it (Gauss-Legendre in each section). The shape functions
/// P_a of an angle at these points give angle(s) = base(s) clamp + sum over a of P_a(s) x_a.
struct AngleShapes {
  std::vector<double> lengths;  ///< Lengths of the sections, m.
  AngleBasis basis = AngleBasis::polynomial;
  bool is_clamped = true;  ///< The angle at s = 0 is given and not one of the numbers.
  Eigen::VectorXd nodes;   ///< Positions of the numbers, which are the angle's values there, m of arc length.
  Eigen::VectorXd s, weights;         ///< Of the points: m of arc length, and the integral's weights, m.
  std::vector<std::size_t> section;   ///< Of the points, from 0.
  Eigen::MatrixXd values, slopes;     ///< P_a and dP_a/ds (1/m): a row per point, a column per number.
  Eigen::VectorXd base, base_slopes;  ///< Function of the clamp; 0 if the base is free.
  /// (running f)(s_j) is the integral of f from the base to s_j, with f given at the points. Exact for
  /// polynomials of degree points - 1 in each section.
  Eigen::MatrixXd running;

  /// Returns P_a at `at` m, a column per number; the clamp's function last.
  [[nodiscard]] Eigen::RowVectorXd at(double at) const;
};

/// Returns shapes with `nodes` >= 1 numbers (polynomial basis; the other one has one per section, and one at
/// a free base) and `points` >= 1 per section. Throws std::invalid_argument for fewer, no sections, or a
/// length that is not positive and finite.
[[nodiscard]] AngleShapes angle_shapes(const std::vector<double>& lengths, AngleBasis basis, bool is_clamped,
                                       int nodes, int points);

}  // namespace flexura
