#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "flexura/app/gltf.h"
#include "flexura/model/look.h"

namespace flexura {

/// A ring of a tube in its rest shape: a circle about a joint's z.
struct TubeRing {
  Pose pose;          ///< Rest pose of the joint in the world.
  double radius = 0;  ///< m
  std::uint16_t joint = 0;
};

/// Returns the surface through these rings, two or more, that move with their joints. Ends are open.
[[nodiscard]] GltfMesh tube_mesh(std::span<const TubeRing> rings);
/// Adds a lid to a tube's mesh at one of its rings, flat or half a ball. Its outward direction is the ring's
/// z times `side`, which is 1 or -1.
void add_lid(const TubeRing& ring, TipKind kind, double side, GltfMesh& mesh);

/// Returns a ball about the origin, m.
[[nodiscard]] GltfMesh ball_mesh(double radius);
/// Returns a box about the origin with these half edges, m.
[[nodiscard]] GltfMesh box_mesh(const Eigen::Vector3d& half_sizes);
/// Returns the surface at `radius` m from a segment along z, about the origin, of this length, m.
[[nodiscard]] GltfMesh capsule_mesh(double radius, double length);
/// Returns a square about the origin, across z, of this half edge, m.
[[nodiscard]] GltfMesh square_mesh(double half);

}  // namespace flexura
