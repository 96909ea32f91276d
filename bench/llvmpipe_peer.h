#pragma once

#include <memory>

#include "bench/egl_context.h"
#include "bench/peer.h"
#include "bench/render_scene.h"
#include "flexura/camera/sensor.h"

namespace flexura {

struct LlvmpipeConfig {
  int samples = 0;  ///< Samples per pixel; 0: no multisampling.
  PixelKind pixels = PixelKind::color;
  bool reads_depth = false;
  LlvmpipeThreads threads = LlvmpipeThreads::none;
};

/// Returns a renderer that draws the scene's triangles by Mesa's llvmpipe through OpenGL, shaded per pixel.
[[nodiscard]] std::unique_ptr<Peer> llvmpipe_peer(const Setting& setting, LlvmpipeConfig config);

}  // namespace flexura
