#pragma once

#include <memory>

#include "bench/peer.h"
#include "bench/render_scene.h"

namespace flexura {

enum class EmbreeShape {
  triangles,  ///< With normals between those of the corners.
  curves,  ///< The arm as Embree's own round curves, one for each strip of a colour; the screen as triangles.
};

/// The scene as Embree's rays meet it, eight at a time, gray with depth, in the calling thread.
/// `rays_across` squared rays a pixel. std::invalid_argument: a width that is no multiple of eight.
[[nodiscard]] std::unique_ptr<Peer> embree_peer(const Setting& setting, EmbreeShape shape, int rays_across);

}  // namespace flexura
