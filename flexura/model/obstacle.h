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

/// Something the arm must not touch: a convex body.
struct Obstacle {
  std::string name = {};   ///< What messages call it.
  double ignore_base = 0;  ///< This much of the unstretched arm, from its base, may touch it; m.
  /// Signed distance of a point in W to its surface, m; negative inside. Convex.
  std::function<double(const Eigen::Vector3d& p_W)> distance;
  /// Of a plane: its unit normal in W, along which `distance` grows.
  std::optional<Eigen::Vector3d> normal{};
  /// Of a box: the planes of its sides, n p_W = offset, n unit and outwards. `distance` is nowhere below the
  /// height above any of them.
  struct Side {
    Eigen::Vector3d normal;
    double offset = 0;
  };
  std::vector<Side> sides{};  ///< Empty for all but boxes.
};

/// What an obstacle looks like unless its file says otherwise: shares of red, green and blue light that it
/// gives back.
inline constexpr std::array<double, 3> obstacle_color = {0.4, 0.45, 0.4};

/// A half space: all that is not on the side of the plane to which the normal points.
struct PlaneConfig {
  std::string name = {};   ///< What messages call it; "": its kind and place in the list. Of all kinds.
  double ignore_base = 0;  ///< As Obstacle::ignore_base, m. Of all kinds.
  bool may_touch = false;  ///< The arm may touch it: what is grasped. Of all kinds.
  std::array<double, 3> point = {0, 0, 0};       ///< Of the plane, in W, m.
  std::array<double, 3> normal = {0, 1, 0};      ///< Out of it, in W; of any length above 0.
  std::array<double, 3> color = obstacle_color;  ///< Of all kinds.
};

/// A ball.
struct SphereConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> center = {0, 0, 0};  ///< In W, m.
  double radius = 0;                         ///< m
  std::array<double, 3> color = obstacle_color;
};

/// All that is within `radius` of a segment.
struct CapsuleConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> from = {0, 0, 0};  ///< The segment's ends, in W, m; they may be one point.
  std::array<double, 3> to = {0, 0, 0};
  double radius = 0;  ///< m
  std::array<double, 3> color = obstacle_color;
};

/// A box; its rotation is a quaternion (w, x, y, z) from its axes into the world's.
struct BoxConfig {
  std::string name = {};
  double ignore_base = 0;
  bool may_touch = false;
  std::array<double, 3> center = {0, 0, 0};       ///< In W, m.
  std::array<double, 3> half_sizes = {0, 0, 0};   ///< Half its edges along its own axes, m.
  std::array<double, 4> rotation = {1, 0, 0, 0};  ///< Of norm 1.
  std::array<double, 3> color = obstacle_color;
};

/// One `[[obstacle]]` of a file.
using ObstacleConfig = std::variant<PlaneConfig, SphereConfig, CapsuleConfig, BoxConfig>;

const Table<PlaneConfig>& fields_of(const PlaneConfig*);
const Table<SphereConfig>& fields_of(const SphereConfig*);
const Table<CapsuleConfig>& fields_of(const CapsuleConfig*);
const Table<BoxConfig>& fields_of(const BoxConfig*);

/// What the tables describe; an obstacle without a name is called by its kind and its place in the list:
/// "plane 1".
[[nodiscard]] std::vector<Obstacle> obstacles(const std::vector<ObstacleConfig>& configs);

}  // namespace flexura
