#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "flexura/math/dual.h"

namespace flexura {

/// Two doubles processed by one instruction, on every processor of the architecture.
using Lanes = double __attribute__((vector_size(16)));

/// Number of numbers in a T.
template <typename T>
inline constexpr std::size_t lanes_of = 1;
template <>
inline constexpr std::size_t lanes_of<Lanes> = 2;

/// The type that processes several T at once; T itself if there is no such type.
template <typename T>
struct Wide {
  using type = T;
};
template <>
struct Wide<double> {
  using type = Lanes;
};

/// Loads and stores numbers that are consecutive in memory.
template <typename T>
[[nodiscard]] inline T load_lanes(const T* from) {
  return *from;
}
[[nodiscard]] inline Lanes load_lanes(const double* from) { return Lanes{from[0], from[1]}; }
template <typename T>
inline void store_lanes(const T& value, T* to) {
  *to = value;
}
inline void store_lanes(const Lanes& value, double* to) {
  to[0] = value[0];
  to[1] = value[1];
}

/// Returns the greatest of the values.
[[nodiscard]] inline double greatest(double value) { return value; }
[[nodiscard]] inline double greatest(const Lanes& value) { return std::max(value[0], value[1]); }
template <typename T>
[[nodiscard]] double greatest(const Dual<T>& dual) {
  return greatest(dual.value);
}

[[nodiscard]] inline Lanes square_root(const Lanes& value) {
  return Lanes{std::sqrt(value[0]), std::sqrt(value[1])};
}
[[nodiscard]] inline double square_root(double value) { return std::sqrt(value); }
template <typename T>
[[nodiscard]] Dual<T> square_root(const Dual<T>& dual) {
  const T root = square_root(dual.value);
  return {root, 0.5 * dual.slope / root};
}

[[nodiscard]] inline double exponential(double value) { return std::exp(value); }
[[nodiscard]] inline Lanes exponential(const Lanes& value) {
  return Lanes{std::exp(value[0]), std::exp(value[1])};
}
template <typename T>
[[nodiscard]] Dual<T> exponential(const Dual<T>& dual) {
  const T value = exponential(dual.value);
  return {value, value * dual.slope};
}

/// Returns the angle of (x, y) from the x axis, rad; not differentiable at (0, 0).
[[nodiscard]] inline double arc_tangent(double y, double x) { return std::atan2(y, x); }
[[nodiscard]] inline Lanes arc_tangent(const Lanes& y, const Lanes& x) {
  return Lanes{std::atan2(y[0], x[0]), std::atan2(y[1], x[1])};
}
template <typename T>
[[nodiscard]] Dual<T> arc_tangent(const Dual<T>& y, const Dual<T>& x) {
  return {arc_tangent(y.value, x.value),
          (x.value * y.slope - y.value * x.slope) / (x.value * x.value + y.value * y.value)};
}

}  // namespace flexura
