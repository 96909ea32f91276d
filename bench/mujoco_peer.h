#pragma once

#include <memory>

#include "bench/peer.h"
#include "bench/render_scene.h"

namespace flexura {

struct MujocoConfig {
  int samples = 0;  ///< Samples per pixel; 0: no multisampling.
  /// Mesh divisions of a capsule around and along its sides; default: MuJoCo's.
  int slices = 28, stacks = 16;
};

/// Returns a renderer of the scene that uses MuJoCo: colour with depth, in the calling thread. The arm
/// consists of 60 capsules; the first and the last are cylinders, as its ends are flat.
[[nodiscard]] std::unique_ptr<Peer> mujoco_peer(const Setting& setting, MujocoConfig config);

}  // namespace flexura
