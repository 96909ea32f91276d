#pragma once

#include <Eigen/Core>
#include <array>

#include "flexura/math/se3.h"

namespace flexura {

/// The places of the three Gauss points in an interval from 0 to 1.
[[nodiscard]] std::array<double, 3> magnus_points();

/// What three values of a quantity at these points say of an interval of length h: its integral, and what it
/// has of a slope and of a curve, each times h. Linear in the values.
template <typename Value>
[[nodiscard]] std::array<Value, 3> magnus_moments(double h, const Value& first, const Value& second,
                                                  const Value& third) {
  constexpr double slope = 1.2909944487358056;  // sqrt(15) / 3
  return {Value(h * second), Value(slope * h * (third - first)),
          Value(10.0 / 3 * h * (first - 2 * second + third))};
}

/// The twist T whose exponential is X(h) of X' = X hat(x(s)), X(0) = 1, to the sixth power of h (the Magnus
/// expansion; S. Blanes, F. Casas, J. A. Oteo, J. Ros, "The Magnus expansion and some of its applications",
/// 2009, sec. 5.5.1). Exact for a constant x. By the moments a of x, above.
class MagnusStep {
 public:
  using Moments = std::array<Vector6d, 3>;
  using Slopes = std::array<Matrix6d, 3>;
  using Form = std::array<std::array<Matrix6d, 3>, 3>;

  /// Of an interval whose strain has these moments.
  explicit MagnusStep(const Moments& moments);

  [[nodiscard]] const Vector6d& twist() const { return twist_; }
  /// dT/da.
  [[nodiscard]] Slopes slopes() const;
  /// Of a wrench W: the second derivative of W . T by a, in any two directions d and e, is the sum of
  /// d_i^T F_ij e_j.
  [[nodiscard]] Form form(const Vector6d& W) const;

 private:
  struct Factors {
    Slopes U, V;
  };
  [[nodiscard]] Factors factors() const;

  Moments a_;
  // T = a_1 + a_3 / 12 + [U, V] / 240.
  Vector6d C_, U_, V_, twist_;
};

}  // namespace flexura
