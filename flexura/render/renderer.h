#pragma once

#include <memory>

#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/math/simd_path.h"
#include "flexura/render/picture.h"
#include "flexura/render/scene.h"

namespace flexura {

struct PreparedScene;

/// Draws scenes from their exact geometric description (docs/renderer.md). A Renderer reuses memory, so that
/// a second picture of equal size allocates nothing. Only one thread at a time may use a renderer. The result
/// depends only on scene and view, not on earlier pictures.
class Renderer {
 public:
  /// `path`: the instruction set of the fast path. Pictures are equal for all instruction sets.
  explicit Renderer(SimdPath path = best_simd_path());
  ~Renderer();
  /// After a move, the moved-from renderer supports only assignment and destruction.
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws `scene` as seen by `view` into `picture`, which it resizes. The fast path (quick_picture.h) draws
  /// simple parts unless `is_exact`. Throws std::invalid_argument for a scene that check() rejects, a view
  /// that is not finite, or an image without pixels.
  void render(const Scene& scene, const View& view, PixelKind pixels, LightImage& picture,
              bool is_exact = false);

  /// Prepares for queries of true values, without drawing. The queries read `scene`, which must remain
  /// unchanged until the next call. Throws the exceptions of render().
  void prepare(const Scene& scene, const View& view);
  /// Returns the last prepared scene, for the functions in truth.h. The scene is valid until the next call.
  [[nodiscard]] const PreparedScene& prepared() const;

 private:
  struct Work;  // Memory that is reused from picture to picture.
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
