#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "flexura/math/lanes.h"
#include "flexura/math/screw.h"
#include "flexura/math/se3.h"

// Arithmetic of rod motions for any numbers: plain or dual.
namespace flexura {

/// Returns a constant as a number with slope 0.
template <typename S>
[[nodiscard]] Triple<S> constant(const Triple<double>& a) {
  return {a.x + S{}, a.y + S{}, a.z + S{}};
}
template <>
[[nodiscard]] inline Triple<double> constant(const Triple<double>& a) {
  return a;
}
template <typename S>
[[nodiscard]] Triple<S> constant(const Eigen::Vector3d& a) {
  return constant<S>(Triple<double>{a.x(), a.y(), a.z()});
}

/// Returns the value without slopes. For several equal lanes, returns the value of one lane.
[[nodiscard]] inline double plain(double value) { return value; }
[[nodiscard]] inline double plain(const Dual<Lanes>& value) { return value.value[0]; }
template <typename S>
[[nodiscard]] Eigen::Vector3d plain(const Triple<S>& a) {
  return {plain(a.x), plain(a.y), plain(a.z)};
}
template <typename S>
[[nodiscard]] Vector6d plain(const Screw<S>& a) {
  return (Vector6d() << plain(a.linear), plain(a.angular)).finished();
}

/// Returns one of the six components of a screw, linear part first.
template <typename S>
[[nodiscard]] S& component(Screw<S>& a, std::size_t c) {
  Triple<S>& half = c < 3 ? a.linear : a.angular;
  const std::size_t i = c < 3 ? c : c - 3;
  if (i == 0) return half.x;
  return i == 1 ? half.y : half.z;
}
template <typename S>
[[nodiscard]] const S& component(const Screw<S>& a, std::size_t c) {
  const Triple<S>& half = c < 3 ? a.linear : a.angular;
  const std::size_t i = c < 3 ? c : c - 3;
  if (i == 0) return half.x;
  return i == 1 ? half.y : half.z;
}

/// Returns the wrench, about the origin, of a force f that acts at p.
template <typename S>
[[nodiscard]] Screw<S> wrench_at(const Triple<S>& p, const Triple<S>& f) {
  return {f, cross(p, f)};
}

}  // namespace flexura
