#pragma once

#include <array>
#include <cstddef>

#include "flexura/math/factorial.h"
#include "flexura/math/lanes.h"
#include "flexura/math/screw.h"

namespace flexura {

/// One interval of a rod between two nodes. The relative pose of the two nodes is X = exp(twist). The twist
/// is the Magnus expansion (math/magnus.h) of the moments of its strain. With T = Dual, whose slopes are the
/// rates of the moments, results include velocities. The projection of a wrench on the moments then includes
/// the rate of this projection, which Lagrange's equations need.
template <typename T>
class RodInterval {
 public:
  RodInterval() = default;
  RodInterval(const Screw<T>& first, const Screw<T>& second, const Screw<T>& third)
      : a1_(first), a2_(second) {
    const Screw<T> C = bracket(a1_, a2_);
    E_ = 2.0 * third - C;
    U_ = 20.0 * a1_ + third + C;
    V_ = a2_ + (1.0 / 60) * bracket(a1_, E_);
    twist_ = a1_ + (1.0 / 12) * third + (1.0 / 240) * bracket(U_, V_);
    find_coefficients();
  }

  [[nodiscard]] const Screw<T>& twist() const { return twist_; }
  /// Returns the squared turning angle, rad^2.
  [[nodiscard]] T square() const { return dot(twist_.angular, twist_.angular); }
  /// Returns exp(twist), the relative pose.
  [[nodiscard]] Placement<T> placement() const {
    const Triple<T>&w = twist_.angular, &v = twist_.linear;
    const Triple<T> cw = cosc_ * w, sw = sinc_ * w;
    const T xx = cw.x * w.x, yy = cw.y * w.y, zz = cw.z * w.z, xy = cw.x * w.y, xz = cw.x * w.z,
            yz = cw.y * w.z;
    const Triple<T> wv = cross(w, v);
    return {.x = {1.0 - (yy + zz), xy - sw.z, xz + sw.y},
            .y = {xy + sw.z, 1.0 - (xx + zz), yz - sw.x},
            .z = {xz - sw.y, yz + sw.x, 1.0 - (xx + yy)},
            .position = v + cosc_ * wv + deficit_ * cross(w, wv)};
  }
  /// Returns the twist of the interval's end that a change of `twist` causes.
  [[nodiscard]] Screw<T> moved(const Screw<T>& change) const {
    Screw<T> power = change, sum = change;
    for (std::size_t n = 0; n < 4; ++n) {
      power = bracket(twist_, power);
      sum += c_[n] * power;
    }
    return sum;
  }
  /// Returns the projection of a wrench on the three moments. The wrench acts at the interval's end, and is
  /// expressed in the frame of the interval's beginning.
  [[nodiscard]] std::array<Screw<T>, 3> along_moments(const Screw<T>& wrench) const {
    Screw<T> power = wrench, w = wrench;
    for (std::size_t n = 0; n < 4; ++n) {
      power = transposed_bracket(twist_, power);
      w += c_[n] * power;
    }
    // Backwards through the Magnus expansion.
    const Screw<T> by_U = (-1.0 / 240) * transposed_bracket(V_, w);
    const Screw<T> by_V = (1.0 / 240) * transposed_bracket(U_, w);
    const Screw<T> by_E = (1.0 / 60) * transposed_bracket(a1_, by_V);
    const Screw<T> by_C = by_U - by_E;
    return {w + 20.0 * by_U - (1.0 / 60) * transposed_bracket(E_, by_V) - transposed_bracket(a2_, by_C),
            by_V + transposed_bracket(a1_, by_C), (1.0 / 12) * w + by_U + 2.0 * by_E};
  }

  /// Returns the interval without slopes.
  template <typename Q>
  friend RodInterval<Q> still(const RodInterval<Dual<Q>>& moving);
  /// Returns the rate of the twist of the interval's end relative to its beginning, at constant rates of the
  /// moments.
  template <typename Q>
  friend Screw<Q> drift_of(const RodInterval<Dual<Q>>& moving);

 private:
  template <typename Q>
  friend class RodInterval;

  // exp and its derivative are polynomials of ad(twist) with these coefficients (math/se3.cc), which are
  // functions of the squared angle. Here all follow from two power series.
  void find_coefficients() {
    const T x = square();
    const double most = greatest(x);
    const std::size_t for_large = most < 1 ? 8 : max_terms, terms = most < 0.06 ? 5 : for_large;
    T c3 = series[0][terms - 1] + T{}, c4 = series[1][terms - 1] + T{};
    for (std::size_t i = terms - 1; i-- > 0;) {
      c3 = series[0][i] + x * c3;
      c4 = series[1][i] + x * c4;
    }
    deficit_ = (1.0 + 2.0 * (x * (c3 + 2.0 * c4))) / (6.0 + x);
    sinc_ = 1.0 - x * deficit_;
    cosc_ = 3.0 * deficit_ - 2.0 * (x * c4);
    c_ = {2.0 * cosc_ - 0.5 * sinc_, 2.5 * deficit_ - 0.5 * cosc_, c3, c4};
  }

  // Number of terms for a full turn.
  static constexpr std::size_t max_terms = 24;
  static constexpr std::array<std::array<double, max_terms>, 2> series = [] {
    std::array<std::array<double, max_terms>, 2> c{};
    for (std::size_t n = 0; n < 2; ++n) {
      for (std::size_t i = 0; i < max_terms; ++i) {
        const std::size_t k = 2 + i;
        c[n][i] = (k % 2 == 0 ? 1.0 : -1.0) * static_cast<double>(k - 1) / factorial(2 * k + n);
      }
    }
    return c;
  }();

  Screw<T> a1_, a2_, E_, U_, V_, twist_;
  std::array<T, 4> c_;
  T sinc_, cosc_, deficit_;
};

/// Returns the values without slopes.
template <typename Q>
[[nodiscard]] Triple<Q> value_of(const Triple<Dual<Q>>& a) {
  return {a.x.value, a.y.value, a.z.value};
}
template <typename Q>
[[nodiscard]] Screw<Q> value_of(const Screw<Dual<Q>>& a) {
  return {value_of(a.linear), value_of(a.angular)};
}
/// Returns the slopes.
template <typename Q>
[[nodiscard]] Screw<Q> slope_of(const Screw<Dual<Q>>& a) {
  return {{a.linear.x.slope, a.linear.y.slope, a.linear.z.slope},
          {a.angular.x.slope, a.angular.y.slope, a.angular.z.slope}};
}
/// Combines a value and its slope.
template <typename Q>
[[nodiscard]] Screw<Dual<Q>> dual_of(const Screw<Q>& a, const Screw<Q>& b) {
  return {{{a.linear.x, b.linear.x}, {a.linear.y, b.linear.y}, {a.linear.z, b.linear.z}},
          {{a.angular.x, b.angular.x}, {a.angular.y, b.angular.y}, {a.angular.z, b.angular.z}}};
}

template <typename Q>
[[nodiscard]] Screw<Q> drift_of(const RodInterval<Dual<Q>>& moving) {
  const Screw<Q> a1 = slope_of(moving.a1_), a2 = slope_of(moving.a2_), E = slope_of(moving.E_),
                 U = slope_of(moving.U_), V = slope_of(moving.V_);
  const Screw<Q> C = 2.0 * bracket(a1, a2);  // Second derivatives from here on: E'' = -C, U'' = C.
  const Screw<Q> of_V = (1.0 / 60) * (2.0 * bracket(a1, E) - bracket(value_of(moving.a1_), C));
  const Screw<Q> of_twist = (1.0 / 240) * (2.0 * bracket(U, V) + bracket(C, value_of(moving.V_)) +
                                           bracket(value_of(moving.U_), of_V));
  return slope_of(moving.moved(dual_of(slope_of(moving.twist_), of_twist)));
}

template <typename Q>
[[nodiscard]] RodInterval<Q> still(const RodInterval<Dual<Q>>& moving) {
  RodInterval<Q> one{};
  one.a1_ = value_of(moving.a1_);
  one.a2_ = value_of(moving.a2_);
  one.E_ = value_of(moving.E_);
  one.U_ = value_of(moving.U_);
  one.V_ = value_of(moving.V_);
  one.twist_ = value_of(moving.twist_);
  for (std::size_t n = 0; n < 4; ++n) one.c_[n] = moving.c_[n].value;
  one.sinc_ = moving.sinc_.value;
  one.cosc_ = moving.cosc_.value;
  one.deficit_ = moving.deficit_.value;
  return one;
}

}  // namespace flexura
