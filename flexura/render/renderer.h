#pragma once

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/render/picture.h"
#include "flexura/render/quick_picture.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/scene.h"
#include "flexura/render/stage.h"
#include "flexura/render/tiles.h"

namespace flexura {

/// Draws scenes from their exact description (docs/renderer.md). It keeps what can be used again from frame
/// to frame, so that a second picture of the same size allocates nothing; one thread at a time uses it. The
/// same scene and view give the same picture, whatever was drawn before.
class Renderer {
 public:
  /// `path`: the instruction set of what is drawn many pixels at a time; every one gives the same picture.
  explicit Renderer(SimdPath path = best_simd_path()) : quick_(path) {}

  /// Draws what `view` shows of `scene` into `picture`, which is made to fit; plain parts of it in a quick
  /// way (quick_picture.h) unless `is_exact`. std::invalid_argument: a scene that check() refuses, a view
  /// that is not finite, an image without pixels.
  void render(const Scene& scene, const View& view, PixelKind pixels, LightImage& picture,
              bool is_exact = false);

  /// The first step of render(), for those who ask for truth: everything as `view` sees it. What is asked
  /// then reads `scene`, which must stay as it is until the next call. The same errors.
  void prepare(const Scene& scene, const View& view);
  /// What was prepared last, as truth.h asks for it; valid until the next call.
  [[nodiscard]] const View& view() const { return view_; }
  [[nodiscard]] const Stage& stage() const { return stage_; }
  [[nodiscard]] const RayField& rays() const { return rays_; }
  [[nodiscard]] const Tiles& tiles() const { return tiles_; }

 private:
  void render_pixel(int u, int v, PixelKind pixels, LightImage& picture) const;

  View view_;
  RayField rays_;
  Stage stage_;
  Tiles tiles_;
  QuickPicture quick_;
};

}  // namespace flexura
