#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/node.h"
#include "flexura/port/camera_port.h"
#include "flexura/render/renderer.h"
#include "flexura/render/scene_maker.h"
#include "flexura/render/surface_label.h"
#include "flexura/sim/simulated_camera.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

/// What a pixel shows, by the geometry.
struct SeenPixel {
  std::string label;            ///< "section 2", "marker 1", "background", an obstacle's name.
  std::optional<double> depth;  ///< Along the optical axis, m; none where nothing is.
  std::optional<double> s;      ///< On the arm: along the unstretched arm, m.
};

/// Looks through a camera's pixels. One thread at a time uses it.
class PixelProbe {
 public:
  explicit PixelProbe(ViewedRigPtr rig);

  /// What is seen in the middle of a pixel, which is in the image, in the middle of a frame's exposure.
  [[nodiscard]] SeenPixel look(const Shot& shot, int u, int v);

 private:
  [[nodiscard]] std::string label(const SurfaceLabel& label) const;

  ViewedRigPtr rig_;
  SceneMaker maker_;
  Renderer renderer_;
};

/// The answer to `pixel`: the picture's own values, of so many bits, and what is known of them.
/// std::out_of_range for a pixel outside the picture.
[[nodiscard]] Node pixel_node(const Picture& picture, std::int64_t bits, int u, int v, std::int64_t number,
                              const std::optional<SeenPixel>& seen);

}  // namespace flexura
