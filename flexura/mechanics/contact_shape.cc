#include "flexura/mechanics/contact_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "flexura/math/arrays.h"

namespace flexura {
namespace {

// Nearer than this to a centre or an axis, the direction from it is only rounding.
constexpr double no_direction = 1e-12;

[[noreturn]] void refuse(const std::string& name, const char* kind, const char* what) {
  throw std::invalid_argument(fmt::format("{} {}: {}", kind, name, what));
}

template <std::size_t n>
Eigen::Vector<double, static_cast<int>(n)> finite(const std::array<double, n>& from, const std::string& name,
                                                  const char* kind) {
  Eigen::Vector<double, static_cast<int>(n)> result;
  for (std::size_t i = 0; i < n; ++i) result[static_cast<Eigen::Index>(i)] = from[i];
  if (!result.allFinite()) refuse(name, kind, "all numbers must be finite");
  return result;
}

void require_size(double size, const std::string& name, const char* kind) {
  if (!(size > 0) || !std::isfinite(size)) refuse(name, kind, "a size must be above 0 and finite");
}

Eigen::Vector3d across(const Eigen::Vector3d& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return axis.cross(Eigen::Vector3d::Unit(least)).normalized();
}

// Vector from the nearest point of a box to an outside point, in the box's axes.
Eigen::Vector3d beyond_box(const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
  return p.cwiseAbs() - half;
}

}  // namespace

ContactShape::ContactShape(const ObstacleConfig& obstacle, const Pose& X_BW) {
  if (!X_BW.rotation.allFinite() || !X_BW.position.allFinite())
    throw std::invalid_argument("obstacles: the pose of the base must be finite");
  if (const auto* plane = std::get_if<PlaneConfig>(&obstacle)) {
    const Eigen::Vector3d point = finite(plane->point, plane->name, "plane");
    const Eigen::Vector3d normal = finite(plane->normal, plane->name, "plane");
    if (!(normal.stableNorm() > 0)) refuse(plane->name, "plane", "the normal must not be zero");
    shape_ = Plane{.point = X_BW * point, .normal = X_BW.rotation * normal.stableNormalized()};
  } else if (const auto* sphere = std::get_if<SphereConfig>(&obstacle)) {
    const Eigen::Vector3d center = finite(sphere->center, sphere->name, "sphere");
    require_size(sphere->radius, sphere->name, "sphere");
    shape_ = Capsule{
        .from = X_BW * center, .along = Eigen::Vector3d::UnitZ(), .length = 0, .radius = sphere->radius};
  } else if (const auto* capsule = std::get_if<CapsuleConfig>(&obstacle)) {
    const Eigen::Vector3d from = X_BW * finite(capsule->from, capsule->name, "capsule");
    const Eigen::Vector3d way = X_BW * finite(capsule->to, capsule->name, "capsule") - from;
    require_size(capsule->radius, capsule->name, "capsule");
    const double length = way.stableNorm();
    if (!std::isfinite(length)) refuse(capsule->name, "capsule", "a size must be above 0 and finite");
    shape_ = Capsule{.from = from,
                     .along = length > 0 ? Eigen::Vector3d(way / length) : Eigen::Vector3d::UnitZ(),
                     .length = length,
                     .radius = capsule->radius};
  } else {
    const auto& box = std::get<BoxConfig>(obstacle);
    const Eigen::Vector3d center = finite(box.center, box.name, "box"),
                          half = finite(box.half_sizes, box.name, "box");
    const Eigen::Vector4d rotation = finite(box.rotation, box.name, "box");
    for (const double size : half) require_size(size, box.name, "box");
    if (!(std::abs(rotation.norm() - 1) < 1e-3)) refuse(box.name, "box", "a rotation must have the norm 1");
    shape_ =
        Box{.X_BO = X_BW * Pose{.rotation = rotation_of(box.rotation), .position = center}, .half = half};
  }
  ignore_base_ = std::visit([](const auto& one) { return one.ignore_base; }, obstacle);
  if (!(ignore_base_ >= 0) || !std::isfinite(ignore_base_))
    throw std::invalid_argument("obstacles: ignore_base must be at least 0 and finite");
}

double ContactShape::half_thickness() const {
  if (const auto* capsule = std::get_if<Capsule>(&shape_)) return capsule->radius;
  if (const auto* box = std::get_if<Box>(&shape_)) return box->half.minCoeff();
  return std::numeric_limits<double>::infinity();
}

double ContactShape::distance(const Eigen::Vector3d& p_B) const {
  if (const auto* plane = std::get_if<Plane>(&shape_)) return plane->normal.dot(p_B - plane->point);
  if (const auto* capsule = std::get_if<Capsule>(&shape_)) {
    const Eigen::Vector3d from = p_B - capsule->from;
    const double u = std::clamp(from.dot(capsule->along), 0.0, capsule->length);
    return (from - u * capsule->along).norm() - capsule->radius;
  }
  const Box& box = std::get<Box>(shape_);
  const Eigen::Vector3d beyond =
      beyond_box(box.X_BO.rotation.transpose() * (p_B - box.X_BO.position), box.half);
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

NearestPoint ContactShape::nearest(const Eigen::Vector3d& p_B) const {
  NearestPoint result;
  if (const auto* plane = std::get_if<Plane>(&shape_)) {
    result.distance = plane->normal.dot(p_B - plane->point);
    result.normal = plane->normal;
    return result;
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape_)) {
    const Eigen::Vector3d from = p_B - capsule->from;
    const double along = from.dot(capsule->along), u = std::clamp(along, 0.0, capsule->length);
    const Eigen::Vector3d off = from - u * capsule->along;
    const double norm = off.norm();
    result.distance = norm - capsule->radius;
    if (!(norm > no_direction)) {
      result.normal = across(capsule->along);
      return result;
    }
    result.normal = off / norm;
    result.curvature.setIdentity();
    result.curvature -= result.normal * result.normal.transpose();
    if (along > 0 && along < capsule->length) result.curvature -= capsule->along * capsule->along.transpose();
    result.curvature /= norm;
    return result;
  }
  const Box& box = std::get<Box>(shape_);
  const Eigen::Matrix3d& R = box.X_BO.rotation;
  const Eigen::Vector3d p = R.transpose() * (p_B - box.X_BO.position), beyond = beyond_box(p, box.half);
  Eigen::Index most = 0;
  const double side = beyond.maxCoeff(&most);
  const auto sign = [&](Eigen::Index axis) { return p[axis] < 0 ? -1.0 : 1.0; };
  if (side <= no_direction) {
    result.distance = side;
    result.normal = sign(most) * R.col(most);
    return result;
  }
  Eigen::Vector3d off = Eigen::Vector3d::Zero(), ends = Eigen::Vector3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (beyond[axis] <= 0) continue;
    off[axis] = sign(axis) * beyond[axis];
    ends[axis] = 1;
  }
  result.distance = off.norm();
  const Eigen::Vector3d normal = off / result.distance;
  Eigen::Matrix3d curvature = -normal * normal.transpose();
  curvature.diagonal() += ends;
  result.normal = R * normal;
  result.curvature = R * (curvature / result.distance) * R.transpose();
  return result;
}

}  // namespace flexura
