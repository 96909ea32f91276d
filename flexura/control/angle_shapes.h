#pragma once

#include <Eigen/Core>
#include <vector>

namespace flexura {

/// Functions of arc length that represent an angle of a distributed arm by finitely many coordinates.
enum class AngleBasis {
  /// One polynomial along the whole arm. The coordinates are the polynomial's values at Gauss-Legendre nodes.
  polynomial,
  /// Linear in every section. The coordinates are the angle's values at the sections' ends, and at the base
  /// if the base is free.
  sections,
};

/// Shape functions of an angle, and the Gauss-Legendre points of each section for integrals along the
/// unstretched arm. The shape functions P_a and the coordinates x_a give angle(s) = base(s) clamp + sum over
/// a of P_a(s) x_a.
struct AngleShapes {
  std::vector<double> lengths;  ///< Lengths of the sections, m.
  AngleBasis basis = AngleBasis::polynomial;
  bool is_clamped = true;  ///< Whether the angle at s = 0 is given instead of a coordinate.
  /// Arc lengths of the nodes, m. The coordinates are the angle's values at the nodes.
  Eigen::VectorXd nodes;
  Eigen::VectorXd s,
      weights;  ///< Arc lengths of the quadrature points, and their weights in integrals, m.
  std::vector<std::size_t> section;  ///< Section of each point, counted from 0.
  Eigen::MatrixXd values, slopes;    ///< P_a and dP_a/ds (1/m): one row per point, one column per coordinate.
  /// The clamp's function base(s) and its derivative (1/m) at the points; 0 if the base is free.
  Eigen::VectorXd base, base_slopes;
  /// (running f)(s_j) is the integral of f from the base to s_j, with f given at the points. The integral is
  /// exact for polynomials of degree points - 1 in each section.
  Eigen::MatrixXd running;

  /// Returns P_a at the arc length `at`, m: one column per coordinate. The last column is the clamp's
  /// function.
  [[nodiscard]] Eigen::RowVectorXd at(double at) const;
};

/// Returns shapes with `points` >= 1 quadrature points per section. `nodes` >= 1 is the number of coordinates
/// in the polynomial basis. The basis `sections` has one coordinate per section, and one more coordinate if
/// the base is free. Throws std::invalid_argument for smaller numbers, no sections, or a length that is not
/// positive and finite.
[[nodiscard]] AngleShapes angle_shapes(const std::vector<double>& lengths, AngleBasis basis, bool is_clamped,
                                       int nodes, int points);

}  // namespace flexura
