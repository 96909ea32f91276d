#pragma once

#include <memory>

#include "bench/peer.h"
#include "bench/render_scene.h"

namespace flexura {

enum class EmbreeShape {
  triangles,  ///< With normals interpolated between corners.
  curves,     ///< The arm as Embree's round curves, one for each strip of a colour; the screen as triangles.
};

/// Returns a renderer of the scene that uses Embree: packets of eight rays, gray with depth, in the calling
/// thread, `rays_across` squared rays a pixel. Throws std::invalid_argument if the width is not a multiple of
/// eight.
[[nodiscard]] std::unique_ptr<Peer> embree_peer(const Setting& setting, EmbreeShape shape, int rays_across);

}  // namespace flexura
