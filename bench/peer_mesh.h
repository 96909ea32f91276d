#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bench/render_scene.h"
#include "flexura/math/pose.h"
#include "flexura/render/scene.h"

namespace flexura {

/// A part of the arm of one colour.
struct Strip {
  double s_from = 0, s_to = 0;  ///< m from the base.
  Color albedo;
};
/// From the base to the tip.
[[nodiscard]] std::vector<Strip> strips_of(const ArmLook& arm);

/// The backbone's frame, in W.
[[nodiscard]] Pose pose_at(const ArmLook& arm, double s);
/// Of a tube of one radius, m.
[[nodiscard]] double radius_of(const ArmLook& arm);
[[nodiscard]] double length_of(const ArmLook& arm);

/// What a surface shows at a corner: albedo * (ambient + directional * max(0, normal . light)). A screen,
/// which shines by itself, has the normal 0 and its brightness over `ambient` as albedo.
struct Corner {
  Eigen::Vector3f position;  ///< In C, m.
  Eigen::Vector3f normal;    ///< In C.
  Eigen::Vector3f albedo;
};

struct PeerMesh {
  std::vector<Corner> corners;
  std::vector<std::uint32_t> triangles;  ///< Three corners each, counter-clockwise from outside.
};

/// Arm and screens in triangles: 24 sides, a hundred rows of quadrangles a metre, 5,186 triangles in
/// `setting()`.
[[nodiscard]] PeerMesh mesh_of(const Setting& setting);

/// Towards the light, in C.
[[nodiscard]] Eigen::Vector3f light_in_camera(const Setting& setting);

}  // namespace flexura
