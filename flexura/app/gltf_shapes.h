#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "flexura/app/gltf.h"
#include "flexura/model/look.h"

namespace flexura {

/// Cross-section of an undeformed tube: a circle about the z axis of a joint.
struct TubeRing {
  Pose pose;          ///< Rest pose of the joint in the world.
  double radius = 0;  ///< m
  std::uint16_t joint = 0;
};

/// Returns the surface through at least two rings, which move with their joints. The tube's ends are open.
[[nodiscard]] GltfMesh tube_mesh(std::span<const TubeRing> rings);
/// Closes a tube's mesh at one of its rings with a flat or hemispherical cap. The cap's outward direction is
/// the ring's z axis times `side`, which is 1 or -1.
void add_lid(const TubeRing& ring, TipKind kind, double side, GltfMesh& mesh);

/// Returns a sphere with the radius `radius`, m, centred at the origin.
[[nodiscard]] GltfMesh ball_mesh(double radius);
/// Returns a box centred at the origin with these half edge lengths, m.
[[nodiscard]] GltfMesh box_mesh(const Eigen::Vector3d& half_sizes);
/// Returns a capsule centred at the origin. The axis of the capsule is a segment along z of the given length;
/// radius and length in m.
[[nodiscard]] GltfMesh capsule_mesh(double radius, double length);
/// Returns a square in the xy plane centred at the origin. `half` is half its edge length, m.
[[nodiscard]] GltfMesh square_mesh(double half);

}  // namespace flexura
