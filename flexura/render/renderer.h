#pragma once

#include <memory>

#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/math/simd_path.h"
#include "flexura/render/picture.h"
#include "flexura/render/scene.h"

namespace flexura {

struct PreparedScene;

/// Draws scenes from their exact description (docs/renderer.md). Storage is reused from frame to frame, so
/// that a second picture of the same size allocates nothing; use it from one thread at a time. The result
/// depends on scene and view alone, not on earlier pictures.
class Renderer {
 public:
  /// `path`: the instruction set of the fast path; all give the same picture.
  explicit Renderer(SimdPath path = best_simd_path());
  ~Renderer();
  /// After a move, the source supports only assignment and destruction.
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws `scene` as seen by `view` into `picture`, which is resized. Simple parts are drawn by the fast
  /// path (quick_picture.h) unless `is_exact`. Throws std::invalid_argument for a scene that check() refuses,
  /// a view that is not finite, or an image without pixels.
  void render(const Scene& scene, const View& view, PixelKind pixels, LightImage& picture,
              bool is_exact = false);

  /// Runs the first step of render() only, for queries of true values. These read `scene`, which must stay
  /// unchanged until the next call. Throws as render() does.
  void prepare(const Scene& scene, const View& view);
  /// Returns what was prepared last, for truth.h; valid until the next call.
  [[nodiscard]] const PreparedScene& prepared() const;

 private:
  struct Work;  // Storage kept from picture to picture, of internal types.
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
