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
  std::string name = {};   ///< Name in messages.
  double ignore_base = 0;  ///< Length of the unstretched arm, from its base, that may touch it, m.
  /// Returns the signed distance of a point in W to its surface, m; negative inside. Convex.
  std::function<double(const Eigen::Vector3d& p_W)> distance;
  /// For a plane: its unit normal in W, along which `distance` grows.
  std::optional<Eigen::Vector3d> normal{};
  /// For a box: the planes of its sides, n p_W = offset, n unit and outwards. `distance` is nowhere below the
  /// height above any of them.
  struct Side {
    Eigen::Vector3d normal;
    double offset = 0;
  };
  std::vector<Side> sides{};  ///< Empty except for boxes.
};

/// Default colour of an obstacle: reflected shares of red, green and blue light.
inline constexpr std::array<double, 3> obstacle_color = {0.4, 0.45, 0.4};

/// A half space: everything on the side opposite to the plane's normal.
struct PlaneConfig {
  std::string name = {};   ///< Name in messages, for all kinds; "": its kind and position in the list.
  double ignore_base = 0;  ///< Obstacle::ignore_base, m; for all kinds.
  bool may_touch = false;  ///< The arm may touch it, for example to grasp it; for all kinds.
  std::array<double, 3> point = {0, 0, 0};       ///< Point of the plane, in W, m.
  std::array<double, 3> normal = {0, 1, 0};      ///< Outward normal, in W; of any length above 0.
  std::array<double, 3> color = obstacle_color;  ///< For all kinds.
};

/// A ball.
struct SphereConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> center = {0, 0, 0};  ///< In W, m.
  double radius = 0;                         ///< m.
  std::array<double, 3> color = obstacle_color;
};

/// All points within `radius` of a segment.
struct CapsuleConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> from = {0, 0, 0};  ///< Ends of the segment, in W, m; they may be equal.
  std::array<double, 3> to = {0, 0, 0};
  double radius = 0;  ///< m.
  std::array<double, 3> color = obstacle_color;
};

/// A box; its rotation is a quaternion (w, x, y, z) from its axes to the world's.
struct BoxConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> center = {0, 0, 0};       ///< In W, m.
  std::array<double, 3> half_sizes = {0, 0, 0};   ///< Half its edges along its axes, m.
  std::array<double, 4> rotation = {1, 0, 0, 0};  ///< Of norm 1.
  std::array<double, 3> color = obstacle_color;
};

/// One `[[obstacle]]` of a file.
using ObstacleConfig = std::variant<PlaneConfig, SphereConfig, CapsuleConfig, BoxConfig>;

const Table<PlaneConfig>& fields_of(const PlaneConfig*);
const Table<SphereConfig>& fields_of(const SphereConfig*);
const Table<CapsuleConfig>& fields_of(const CapsuleConfig*);
const Table<BoxConfig>& fields_of(const BoxConfig*);

/// Returns the obstacles of the tables. One without a name has its kind and its position in the list as its
/// name: "plane 1".
[[nodiscard]] std::vector<Obstacle> obstacles(const std::vector<ObstacleConfig>& configs);

}  // namespace flexura
