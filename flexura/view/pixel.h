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

/// What a pixel of a picture shows, according to the geometry.
struct SeenPixel {
  std::string label;  ///< Visible object: "section 2", "marker 1", "background", or an obstacle's name.
  std::optional<double> depth;  ///< Depth along the optical axis, m; missing if there is no surface.
  std::optional<double> s;      ///< For the arm: arc length along the unstretched arm, m.
};

/// Determines what a camera's pixels show. Not thread-safe.
class PixelProbe {
 public:
  explicit PixelProbe(ViewedRigPtr rig);

  /// Returns what is visible at the centre of a pixel, at mid-exposure of the frame.
  [[nodiscard]] SeenPixel look(const Shot& shot, int u, int v);

 private:
  [[nodiscard]] std::string label(const SurfaceLabel& label) const;

  ViewedRigPtr rig_;
  SceneMaker maker_;
  Renderer renderer_;
};

/// Returns the answer to the request `pixel`: the values of the pixel, with `bits` bits, and what the pixel
/// shows. Throws std::out_of_range for a pixel outside the picture.
[[nodiscard]] Node pixel_node(const Picture& picture, std::int64_t bits, int u, int v, std::int64_t number,
                              const std::optional<SeenPixel>& seen);

}  // namespace flexura
