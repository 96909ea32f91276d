#pragma once

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/scene.h"
#include "flexura/render/stage.h"
#include "flexura/render/tiles.h"

namespace flexura {

/// What reaches the image plane of an ideal camera: each pixel's light is the mean over its square.
struct Picture {
  Image<float> light;  ///< One channel (gray) or three (red, green, blue); linear, in the scene's units.
  Image<float>
      depth;  ///< In the middle of each pixel, along the optical axis, m; infinity: nothing is there.
};

/// Draws scenes from their exact description (docs/renderer.md). It keeps what can be used again from frame
/// to frame, so that a second picture of the same size allocates nothing; one thread at a time uses it. The
/// same scene and view give the same picture, whatever was drawn before.
class Renderer {
 public:
  /// Draws what `view` shows of `scene` into `picture`, which is made to fit.
  /// std::invalid_argument: a scene that check() refuses, a view that is not finite, an image without pixels.
  void render(const Scene& scene, const View& view, PixelKind pixels, Picture& picture);

  /// The first step of render(), for those who ask for truth: everything as `view` sees it. What is asked
  /// then reads `scene`, which must stay as it is until the next call.
  void prepare(const Scene& scene, const View& view);
  [[nodiscard]] const View& view() const { return view_; }
  [[nodiscard]] const Stage& stage() const { return stage_; }
  [[nodiscard]] const RayField& rays() const { return rays_; }
  [[nodiscard]] const Tiles& tiles() const { return tiles_; }

 private:
  void render_tile(int column, int row, PixelKind pixels, Picture& picture) const;

  View view_;
  RayField rays_;
  Stage stage_;
  Tiles tiles_;
};

}  // namespace flexura
