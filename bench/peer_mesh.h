#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bench/render_scene.h"
#include "flexura/math/pose.h"
#include "flexura/render/scene.h"

namespace flexura {

/// A part of the arm with one colour.
struct Strip {
  double s_from = 0, s_to = 0;  ///< Arc lengths from the base, m.
  Color albedo;
};
/// Returns the strips from the base to the tip.
[[nodiscard]] std::vector<Strip> strips_of(const ArmLook& arm);

/// Returns the backbone's frame at s, in W.
[[nodiscard]] Pose pose_at(const ArmLook& arm, double s);
/// Returns the radius of an arm of constant radius, m.
[[nodiscard]] double radius_of(const ArmLook& arm);
[[nodiscard]] double length_of(const ArmLook& arm);

/// A corner of a surface. Its brightness is albedo * (ambient + directional * max(0, normal . light)). A
/// screen shines by itself: its normal is 0 and its albedo is its brightness over `ambient`.
struct Corner {
  Eigen::Vector3f position;  ///< In C, m.
  Eigen::Vector3f normal;    ///< In C.
  Eigen::Vector3f albedo;
};

struct PeerMesh {
  std::vector<Corner> corners;
  std::vector<std::uint32_t> triangles;  ///< Three corners each, counter-clockwise from outside.
};

/// Returns arm and screens as triangles: 24 sides, a hundred rows of quadrangles a metre, 5,186 triangles in
/// `setting()`.
[[nodiscard]] PeerMesh mesh_of(const Setting& setting);

/// Returns the direction towards the light, in C.
[[nodiscard]] Eigen::Vector3f light_in_camera(const Setting& setting);

}  // namespace flexura
