#pragma once

#include <Eigen/Core>
#include <limits>
#include <variant>

#include "flexura/math/pose.h"
#include "flexura/model/obstacle.h"

namespace flexura {

/// Of a point near a body: its signed distance to the surface, m, negative inside; the unit normal there, out
/// of the body, which is the distance's gradient; and the derivative of the normal, symmetric, 1/m. The
/// nearest point of the surface is point - distance normal.
struct NearestPoint {
  double distance = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
};

/// A convex body that a rod can touch: a plane, a ball, a capsule or a box of a file, in the frame of the
/// rod's base.
class ContactShape {
 public:
  /// `X_BW`: the pose of the obstacle's frame in the base's. std::invalid_argument: numbers that are not
  /// finite, a size that is not above 0, a normal or a rotation without direction.
  ContactShape(const ObstacleConfig& obstacle, const Pose& X_BW);

  /// Always finite for a finite point. Where several points of the surface are nearest (the centre of a ball,
  /// the axis of a capsule, the diagonals of a box) one of them is taken.
  [[nodiscard]] NearestPoint nearest(const Eigen::Vector3d& p_B) const;
  /// The signed distance alone.
  [[nodiscard]] double distance(const Eigen::Vector3d& p_B) const;
  /// So much of the rod, from its base on, may touch it; m.
  [[nodiscard]] double ignore_base() const { return ignore_base_; }

 private:
  struct Plane {
    Eigen::Vector3d point, normal;
  };
  // A ball where `length` is 0.
  struct Capsule {
    Eigen::Vector3d from, along;
    double length, radius;
  };
  struct Box {
    Pose X_BO;
    Eigen::Vector3d half;
  };
  std::variant<Plane, Capsule, Box> shape_;
  double ignore_base_ = 0;
};

}  // namespace flexura
