#pragma once

#include <Eigen/Core>
#include <vector>

namespace flexura {

/// By which functions of arc length an angle of a distributed arm is made of finitely many numbers.
enum class AngleBasis {
  polynomial,  ///< One polynomial along the whole arm, by its values at Gauss-Legendre nodes.
  sections,    ///< Linear in every section, by its values at the sections' ends (and at the base).
};

/// Points of the unstretched arm at which integrals along it are taken (Gauss-Legendre in each section), and
/// the shape functions of an angle there: angle(s) = base(s) clamp + sum over a of P_a(s) x_a.
struct AngleShapes {
  std::vector<double> lengths;  ///< Of the sections, m.
  AngleBasis basis = AngleBasis::polynomial;
  bool is_clamped = true;             ///< The angle at s = 0 is given and is none of the numbers.
  Eigen::VectorXd nodes;              ///< Where the numbers are the angle's values, m of arc length.
  Eigen::VectorXd s, weights;         ///< Of the points: m of arc length, and the integral's weights, m.
  std::vector<std::size_t> section;   ///< Of the points, from 0.
  Eigen::MatrixXd values, slopes;     ///< P_a and dP_a/ds (1/m): a row a point, a column a number.
  Eigen::VectorXd base, base_slopes;  ///< The clamp's own function; 0 where the base is free.
  /// (running f)(s_j) is the integral of f from the base to s_j, of f given at the points: exact for
  /// polynomials of degree points - 1 in each section.
  Eigen::MatrixXd running;

  /// P_a at `at` m, a column a number; the clamp's function last.
  [[nodiscard]] Eigen::RowVectorXd at(double at) const;
};

/// `nodes` >= 1 numbers (polynomial basis; the other has one a section, and one at a free base), `points` >=
/// 1 a section. std::invalid_argument: fewer, no sections, a length that is not positive and finite.
[[nodiscard]] AngleShapes angle_shapes(const std::vector<double>& lengths, AngleBasis basis, bool is_clamped,
                                       int nodes, int points);

}  // namespace flexura
