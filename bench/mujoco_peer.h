#pragma once

#include <memory>

#include "bench/peer.h"
#include "bench/render_scene.h"

namespace flexura {

struct MujocoConfig {
  int samples = 0;  ///< A pixel, where there are several.
  /// In how many parts a capsule is meshed around and along its sides; as MuJoCo does when nothing is said.
  int slices = 28, stacks = 16;
};

/// The scene drawn by MuJoCo in colour with depth, in the calling thread: the arm as 60 capsules, of which
/// the first and the last are cylinders, as its ends are flat.
[[nodiscard]] std::unique_ptr<Peer> mujoco_peer(const Setting& setting, MujocoConfig config);

}  // namespace flexura
