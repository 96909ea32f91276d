#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/math/so3.h"
#include "flexura/model/obstacle.h"
#include "flexura/render/scene.h"

namespace flexura {

/// Reference bodies for tests of the renderer. A body is the set where several quadratic functions are all
/// negative. A ray enters it where the last of their intervals begins. It shares no equation with
/// flexura/render.
class ImplicitBody {
 public:
  /// Depth of a ray that does not enter.
  static constexpr double nowhere = std::numeric_limits<double>::infinity();

  /// Adds |P (p - c)|^2 < 1: the rows of P are the bounded directions, divided by their half widths.
  ImplicitBody& within(const Eigen::Vector3d& c, const Eigen::Matrix3d& P) {
    quadrics_.push_back({P, -P * c});
    return *this;
  }
  /// Adds n . (p - c) < 0.
  ImplicitBody& below(const Eigen::Vector3d& c, const Eigen::Vector3d& n) {
    planes_.push_back({n, n.dot(c)});
    return *this;
  }

  /// Returns the depth > 0 at which eye + depth * direction enters from outside.
  [[nodiscard]] double entry(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) const {
    double from = -nowhere, to = nowhere;
    const auto cut = [&](double low, double high) { from = std::max(from, low), to = std::min(to, high); };
    for (const Quadric& quadric : quadrics_) {
      const Eigen::Vector3d e = quadric.P * eye + quadric.offset, d = quadric.P * direction;
      const double a = d.squaredNorm(), b = e.dot(d), c = e.squaredNorm() - 1;
      const double root = b * b - a * c;
      if (a == 0 && c < 0) continue;
      if (!(root > 0) || a == 0) return nowhere;
      cut((-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a);
    }
    for (const Plane& plane : planes_) {
      const double slope = plane.normal.dot(direction), height = plane.normal.dot(eye) - plane.offset;
      if (slope > 0) cut(-nowhere, -height / slope);
      if (slope < 0) cut(-height / slope, nowhere);
      if (slope == 0 && height >= 0) return nowhere;
    }
    return from < to && from > 0 ? from : nowhere;
  }

  static ImplicitBody sphere(const Eigen::Vector3d& center, double radius) {
    return ImplicitBody().within(center, Eigen::Matrix3d::Identity() / radius);
  }
  /// Returns a cylinder around the z axis of X_WS, starting at its origin.
  static ImplicitBody cylinder(const Pose& X_WS, double length, double radius) {
    const Eigen::Vector3d z = X_WS.rotation.col(2);
    const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - z * z.transpose()) / radius;
    return ImplicitBody()
        .within(X_WS.position, across)
        .below(X_WS.position, -z)
        .below(X_WS.position + length * z, z);
  }

 private:
  struct Quadric {
    Eigen::Matrix3d P;
    Eigen::Vector3d offset;
  };
  struct Plane {
    Eigen::Vector3d normal;
    double offset;
  };
  std::vector<Quadric> quadrics_;
  std::vector<Plane> planes_;
};

/// Returns the bodies whose union is a configured obstacle.
inline std::vector<ImplicitBody> implicit_bodies(const ObstacleConfig& obstacle) {
  const auto point = [](const std::array<double, 3>& p) { return Eigen::Vector3d(p[0], p[1], p[2]); };
  if (const auto* sphere = std::get_if<SphereConfig>(&obstacle))
    return {ImplicitBody::sphere(point(sphere->center), sphere->radius)};
  if (const auto* plane = std::get_if<PlaneConfig>(&obstacle))
    return {ImplicitBody().below(point(plane->point), point(plane->normal))};
  if (const auto* capsule = std::get_if<CapsuleConfig>(&obstacle)) {
    const Eigen::Vector3d from = point(capsule->from), to = point(capsule->to);
    const Pose X_WS{rotation_from_z(to - from), from};
    return {ImplicitBody::sphere(from, capsule->radius), ImplicitBody::sphere(to, capsule->radius),
            ImplicitBody::cylinder(X_WS, (to - from).norm(), capsule->radius)};
  }
  const auto& box = std::get<BoxConfig>(obstacle);
  const auto& [w, x, y, z] = box.rotation;
  const Eigen::Matrix3d axes = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  ImplicitBody body;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Eigen::Matrix3d slab = Eigen::Matrix3d::Zero();
    slab.row(0) = axes.col(i).transpose() / box.half_sizes[static_cast<std::size_t>(i)];
    body.within(point(box.center), slab);
  }
  return {body};
}

inline ImplicitBody implicit_disk(const Pose& X_WS, const GuideDisk& disk) {
  Pose bottom = X_WS;
  bottom.position -= 0.5 * disk.thickness * X_WS.rotation.col(2);
  return ImplicitBody::cylinder(bottom, disk.thickness, disk.radius);
}

/// Returns the calibration cylinder without its lines.
inline ImplicitBody implicit_etalon(const Etalon& etalon) {
  const Eigen::Vector3d up = etalon.X_WE.rotation.col(1);
  const Pose bottom{rotation_from_z(up), etalon.X_WE.position - 0.5 * etalon.height * up};
  return ImplicitBody::cylinder(bottom, etalon.height, etalon.radius);
}

/// Returns whether a surface point is on one of the four lines along the side, a quarter turn apart, the
/// first at +Z.
inline bool is_on_etalon_line(const Etalon& etalon, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p = etalon.X_WE.inverse() * p_W;
  const bool is_on_end = std::abs(p.y()) > 0.5 * etalon.height * (1 - 1e-9);
  // The smaller of |x| and |z| is the distance from the nearest line's plane.
  const double off = std::asin(std::min(std::abs(p.x()), std::abs(p.z())) / etalon.radius) * etalon.radius;
  return !is_on_end && off < 0.5 * etalon.line_width;
}

}  // namespace flexura
