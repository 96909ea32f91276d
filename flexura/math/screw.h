#pragma once

namespace flexura {

/// A vector of three numbers of type T: double, several doubles per instruction, or dual numbers.
template <typename T>
struct Triple {
  T x, y, z;

  Triple& operator+=(const Triple& b) { return *this = *this + b; }
  Triple& operator-=(const Triple& b) { return *this = *this - b; }
  friend Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Triple operator-(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Triple operator-(const Triple& a) { return {-a.x, -a.y, -a.z}; }
  template <typename Factor>
  friend Triple operator*(const Factor& f, const Triple& a) {
    return {f * a.x, f * a.y, f * a.z};
  }
};

template <typename T>
[[nodiscard]] T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
[[nodiscard]] Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A twist [v; w] or a wrench [f; m], the linear part first.
template <typename T>
struct Screw {
  Triple<T> linear, angular;

  Screw& operator+=(const Screw& b) { return *this = *this + b; }
  Screw& operator-=(const Screw& b) { return *this = *this - b; }
  friend Screw operator+(const Screw& a, const Screw& b) {
    return {a.linear + b.linear, a.angular + b.angular};
  }
  friend Screw operator-(const Screw& a, const Screw& b) {
    return {a.linear - b.linear, a.angular - b.angular};
  }
  template <typename Factor>
  friend Screw operator*(const Factor& f, const Screw& a) {
    return {f * a.linear, f * a.angular};
  }
};

/// Returns the Lie bracket [a, b] = ad(a) b of two twists.
template <typename T>
[[nodiscard]] Screw<T> bracket(const Screw<T>& a, const Screw<T>& b) {
  return {cross(a.angular, b.linear) + cross(a.linear, b.angular), cross(a.angular, b.angular)};
}
/// Returns ad(a)^T W for a wrench W, so that W . [a, b] = (ad(a)^T W) . b for every twist b.
template <typename T>
[[nodiscard]] Screw<T> transposed_bracket(const Screw<T>& a, const Screw<T>& W) {
  return {cross(W.linear, a.angular), cross(W.linear, a.linear) + cross(W.angular, a.angular)};
}

/// A pose X_AB: the rows x, y, z of the rotation matrix, and the position.
template <typename T>
struct Placement {
  Triple<T> x, y, z, position;

  [[nodiscard]] Triple<T> turn(const Triple<T>& a) const { return {dot(x, a), dot(y, a), dot(z, a)}; }
  [[nodiscard]] Triple<T> turn_back(const Triple<T>& a) const { return a.x * x + a.y * y + a.z * z; }
  /// Converts a twist from frame B to frame A: V_A = adjoint(X_AB) V_B.
  [[nodiscard]] Screw<T> carry(const Screw<T>& V) const {
    const Triple<T> angular = turn(V.angular);
    return {turn(V.linear) + cross(position, angular), angular};
  }
  /// Converts a wrench from frame A to frame B: W_B = adjoint(X_AB)^T W_A.
  [[nodiscard]] Screw<T> fetch(const Screw<T>& W) const {
    return {turn_back(W.linear), turn_back(W.angular - cross(position, W.linear))};
  }
  friend Placement operator*(const Placement& a, const Placement& b) {
    const auto row = [&](const Triple<T>& r) { return r.x * b.x + r.y * b.y + r.z * b.z; };
    return {row(a.x), row(a.y), row(a.z), a.position + a.turn(b.position)};
  }
};

}  // namespace flexura
