#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// A reference tube for tests of the renderer: many conical frustums between poses of the backbone, each
/// intersected with rays in closed form. It shares no equation with flexura/render.
class FrustumTube {
 public:
  struct Frustum {
    Eigen::Vector3d from, to;  ///< End points in W.
    double radius_from, radius_to;
    double s_from, s_to;
    bool is_first, is_last;  ///< At an end of the tube or at a step of its radius; closed there by a disc.
    /// Extension beyond both ends, as a share of the length. It closes wedge-shaped gaps to the neighbours on
    /// the outside of a bend.
    double overlap;
    Eigen::Vector3d tangent_from, tangent_to;  ///< Tangents of the backbone in W.
  };
  struct Meeting {
    double depth = std::numeric_limits<double>::infinity();
    double s = -1;
  };

  /// `count`: frustums per section.
  FrustumTube(const Arm& arm, const Backbone& backbone, int count) {
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const Arc& arc = backbone.arcs()[i];
      const auto& radius = arm.sections[i].radius;
      const bool starts = i == 0 || arm.sections[i - 1].radius[1] != radius[0];
      const bool ends = i + 1 == arm.sections.size() || arm.sections[i + 1].radius[0] != radius[1];
      for (int part = 0; part < count; ++part) {
        const double a = static_cast<double>(part) / count, b = static_cast<double>(part + 1) / count;
        const double length = arc.length / count, turn = arc.bend.norm() / count;
        const auto mixed = [&](double share) { return radius[0] + (radius[1] - radius[0]) * share; };
        frustums_.push_back({arc.pose(a * arc.length).position, arc.pose(b * arc.length).position, mixed(a),
                             mixed(b), arc.s + a * arc.length, arc.s + b * arc.length, starts && part == 0,
                             ends && part + 1 == count, 0.5 * turn * mixed(a) / length,
                             arc.pose(a * arc.length).rotation.col(2),
                             arc.pose(b * arc.length).rotation.col(2)});
      }
    }
  }

  [[nodiscard]] const std::vector<Frustum>& frustums() const { return frustums_; }

  /// Returns the frustums that rays from `eye` near `direction` may meet: at depth z at most z * spread away.
  [[nodiscard]] std::vector<Frustum> near(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction,
                                          double spread) const {
    std::vector<Frustum> result;
    const Eigen::Vector3d d = direction.normalized();
    for (const Frustum& frustum : frustums_) {
      const Eigen::Vector3d middle = 0.5 * (frustum.from + frustum.to) - eye;
      const double size =
          0.5 * (frustum.to - frustum.from).norm() + std::max(frustum.radius_from, frustum.radius_to);
      const double off = (middle - middle.dot(d) * d).norm();
      if (middle.dot(d) > -size && off < size + spread * (middle.norm() + size)) result.push_back(frustum);
    }
    return result;
  }

  /// Returns where eye + depth * direction, depth > 0, first enters one of the frustums from outside.
  [[nodiscard]] static Meeting meet(const std::vector<Frustum>& frustums, const Eigen::Vector3d& eye,
                                    const Eigen::Vector3d& direction) {
    Meeting nearest;
    for (const Frustum& frustum : frustums) meet_side(frustum, eye, direction, nearest);
    for (const Frustum& frustum : frustums) {
      if (frustum.is_first)
        meet_disc(frustum.from, frustum.tangent_from, frustum.radius_from, frustum.s_from, eye, direction,
                  nearest);
      if (frustum.is_last)
        meet_disc(frustum.to, frustum.tangent_to, frustum.radius_to, frustum.s_to, eye, direction, nearest);
    }
    return nearest;
  }

 private:
  static void meet_side(const Frustum& frustum, const Eigen::Vector3d& eye, const Eigen::Vector3d& direction,
                        Meeting& nearest) {
    const Eigen::Vector3d axis = frustum.to - frustum.from, off = eye - frustum.from;
    const double square = axis.squaredNorm(), widening = frustum.radius_to - frustum.radius_from;
    // At depth t the axial share is a + b t and the radius is radius_from + widening (a + b t).
    const double a = off.dot(axis) / square, b = direction.dot(axis) / square;
    const Eigen::Vector3d across = off - a * axis, moving = direction - b * axis;
    const double radius = frustum.radius_from + widening * a, growing = widening * b;
    const double A = moving.squaredNorm() - growing * growing;
    const double B = across.dot(moving) - radius * growing;
    const double C = across.squaredNorm() - radius * radius;
    const double discriminant = B * B - A * C;
    if (discriminant < 0 || A == 0) return;
    for (const double sign : {-1.0, 1.0}) {
      const double t = (-B + sign * std::sqrt(discriminant)) / A;
      const double share = a + b * t;
      const Eigen::Vector3d p = eye + t * direction;
      const bool is_cut = (frustum.is_first && (p - frustum.from).dot(frustum.tangent_from) < 0) ||
                          (frustum.is_last && (frustum.to - p).dot(frustum.tangent_to) < 0);
      if (t > 0 && t < nearest.depth && share >= -frustum.overlap && share <= 1 + frustum.overlap && !is_cut)
        nearest = {t, s_at(frustum, p)};
    }
  }
  // Interpolates s from the distances to the planes across the backbone at both ends of the frustum.
  static double s_at(const Frustum& frustum, const Eigen::Vector3d& p) {
    const double before = (p - frustum.from).dot(frustum.tangent_from);
    const double after = (frustum.to - p).dot(frustum.tangent_to);
    return frustum.s_from + before / (before + after) * (frustum.s_to - frustum.s_from);
  }
  static void meet_disc(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius, double s,
                        const Eigen::Vector3d& eye, const Eigen::Vector3d& direction, Meeting& nearest) {
    const double t = normal.dot(center - eye) / normal.dot(direction);
    if (t > 0 && t < nearest.depth && (eye + t * direction - center).norm() <= radius) nearest = {t, s};
  }

  std::vector<Frustum> frustums_;
};

}  // namespace flexura
