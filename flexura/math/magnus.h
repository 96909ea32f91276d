#pragma once

#include <Eigen/Core>
#include <array>

#include "flexura/math/se3.h"

namespace flexura {

/// Returns the positions of the three Gauss points in [0, 1].
[[nodiscard]] std::array<double, 3> magnus_points();

/// Returns three moments of a quantity over an interval of length h, from the quantity's values at the three
/// Gauss points. The moments are the integral, and the slope and curvature terms times h. The moments are
/// linear in the values.
template <typename Value>
[[nodiscard]] std::array<Value, 3> magnus_moments(double h, const Value& first, const Value& second,
                                                  const Value& third) {
  constexpr double slope = 1.2909944487358056;  // sqrt(15) / 3.
  return {Value(h * second), Value(slope * h * (third - first)),
          Value(10.0 / 3 * h * (first - 2 * second + third))};
}

/// A step of the Magnus expansion (Blanes, Casas, Oteo, Ros, "The Magnus expansion and some of its
/// applications", 2009, sec. 5.5.1). Let X(s) be the pose with X' = X hat(x(s)) and X(0) = 1, where x is a
/// strain. The step computes the twist T with X(h) = exp(T), accurate to the sixth power of h and exact for a
/// constant x. The input of the step is the moments a of x (magnus_moments).
class MagnusStep {
 public:
  using Moments = std::array<Vector6d, 3>;
  using Slopes = std::array<Matrix6d, 3>;
  using Form = std::array<std::array<Matrix6d, 3>, 3>;

  /// Computes the twist of an interval from the moments of the strain.
  explicit MagnusStep(const Moments& moments);

  [[nodiscard]] const Vector6d& twist() const { return twist_; }
  /// Returns dT/da.
  [[nodiscard]] Slopes slopes() const;
  /// Returns, for a wrench W, the second derivative F of W^T T with respect to a. In any two directions d and
  /// e the second derivative is the sum of d_i^T F_ij e_j.
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
