#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// A convex body that the arm must not touch.
struct Obstacle {
  std::string name = {};  ///< Name in messages.
  /// Length of the part of the arm next to its base that may touch the obstacle, along the unstretched arm,
  /// m.
  double ignore_base = 0;
  /// Signed distance of a point in W from the obstacle's surface, m: a convex function that is negative
  /// inside.
  std::function<double(const Eigen::Vector3d& p_W)> distance;
  /// Unit normal of a plane in W. `distance` increases in the direction of the normal.
  std::optional<Eigen::Vector3d> normal{};
  /// The plane of a side of a box: all points p_W with normal . p_W = offset (m). The normal is a unit vector
  /// in W that points outwards. The height of a point above this plane never exceeds `distance`.
  struct Side {
    Eigen::Vector3d normal;
    double offset = 0;
  };
  std::vector<Side> sides{};  ///< Sides of a box; empty for other obstacles.
};

/// Default colour of an obstacle: reflected shares of red, green and blue light.
inline constexpr std::array<double, 3> obstacle_color = {0.4, 0.45, 0.4};

/// A half space: all points on the side of a plane that is opposite to the plane's normal.
struct PlaneConfig {
  std::string name = {};  ///< Name in messages; "": the obstacle's kind and position in the list.
  /// Length of the part of the arm next to its base that may touch the obstacle, m (Obstacle::ignore_base).
  double ignore_base = 0;
  bool may_touch = false;  ///< Whether the arm may touch the obstacle, for example to grasp it.
  std::array<double, 3> point = {0, 0, 0};  ///< A point of the plane, in W, m.
  /// Normal in W, which points out of the half space. The length of the normal must be above 0.
  std::array<double, 3> normal = {0, 1, 0};
  std::array<double, 3> color = obstacle_color;  ///< Reflected fractions of red, green and blue light.
};

/// A sphere. The members name, ignore_base, may_touch and color are as in PlaneConfig.
struct SphereConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> center = {0, 0, 0};  ///< Centre in W, m.
  double radius = 0;                         ///< m.
  std::array<double, 3> color = obstacle_color;
};

/// A capsule: all points within `radius` of a line segment. The members name, ignore_base, may_touch and
/// color are as in PlaneConfig.
struct CapsuleConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> from = {0, 0, 0};  ///< Start of the segment, in W, m; may equal `to`.
  std::array<double, 3> to = {0, 0, 0};
  double radius = 0;  ///< m.
  std::array<double, 3> color = obstacle_color;
};

/// A box. The members name, ignore_base, may_touch and color are as in PlaneConfig.
struct BoxConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> center = {0, 0, 0};  ///< Centre in W, m.
  /// Half the lengths of the edges along the box's x, y and z, m.
  std::array<double, 3> half_sizes = {0, 0, 0};
  /// Unit quaternion (w, x, y, z) from the box's axes to the world.
  std::array<double, 4> rotation = {1, 0, 0, 0};
  std::array<double, 3> color = obstacle_color;
};

/// An obstacle in a file, `[[obstacle]]`.
using ObstacleConfig = std::variant<PlaneConfig, SphereConfig, CapsuleConfig, BoxConfig>;

const Table<PlaneConfig>& fields_of(const PlaneConfig*);
const Table<SphereConfig>& fields_of(const SphereConfig*);
const Table<CapsuleConfig>& fields_of(const CapsuleConfig*);
const Table<BoxConfig>& fields_of(const BoxConfig*);

/// Returns the obstacles that the tables describe. The name of an obstacle without a name is its kind and its
/// position in the list, counted from 1: "plane 1".
[[nodiscard]] std::vector<Obstacle> obstacles(const std::vector<ObstacleConfig>& configs);

}  // namespace flexura
