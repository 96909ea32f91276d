#pragma once

#include <Eigen/Core>
#include <limits>
#include <variant>

#include "flexura/math/pose.h"
#include "flexura/model/obstacle.h"

namespace flexura {

/// Position of a point relative to a body. `distance`: signed distance to the surface, m, negative inside.
/// `normal`: outward unit normal, the gradient of the distance. `curvature`: derivative of the normal,
/// symmetric, 1/m. The nearest point of the surface is `point - distance * normal`.
struct NearestPoint {
  double distance = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
};

/// An obstacle that a rod can touch: a plane, ball, capsule or box, in the frame of the rod's base.
class ContactShape {
 public:
  /// `X_BW`: pose of the obstacle's frame in the base's frame. Throws std::invalid_argument for numbers that
  /// are not finite, a size that is not positive, or a normal or rotation of zero norm.
  ContactShape(const ObstacleConfig& obstacle, const Pose& X_BW);

  /// Returns the nearest point of the surface; finite for any finite point. If several points are nearest
  /// (centre of a ball, axis of a capsule, diagonals of a box) it returns one of them.
  [[nodiscard]] NearestPoint nearest(const Eigen::Vector3d& p_B) const;
  /// Returns only the signed distance, m.
  [[nodiscard]] double distance(const Eigen::Vector3d& p_B) const;
  /// Returns the smallest distance from the surface to the middle of the body, m. For a ball or a capsule
  /// this is the radius, for a box half the smallest size; for a plane the result is infinite.
  [[nodiscard]] double half_thickness() const;
  /// Returns the length of the part of the rod next to its base that cannot touch the obstacle, m.
  [[nodiscard]] double ignore_base() const { return ignore_base_; }

 private:
  struct Plane {
    Eigen::Vector3d point, normal;
  };
  // `length` 0: a ball.
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
