#pragma once

#include <memory>

#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/math/simd_path.h"
#include "flexura/render/picture.h"
#include "flexura/render/scene.h"

namespace flexura {

struct PreparedScene;

/// Draws scenes from their exact description (docs/renderer.md). It keeps what can be used again from frame
/// to frame, so that a second picture of the same size allocates nothing; one thread at a time uses it. The
/// same scene and view give the same picture, whatever was drawn before.
class Renderer {
 public:
  /// `path`: the instruction set of what is drawn many pixels at a time; every one gives the same picture.
  explicit Renderer(SimdPath path = best_simd_path());
  ~Renderer();
  /// One that was moved from can be assigned to and destroyed, and nothing else.
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws what `view` shows of `scene` into `picture`, which is made to fit; plain parts of it in a quick
  /// way (quick_picture.h) unless `is_exact`. std::invalid_argument: a scene that check() refuses, a view
  /// that is not finite, an image without pixels.
  void render(const Scene& scene, const View& view, PixelKind pixels, LightImage& picture,
              bool is_exact = false);

  /// The first step of render(), for those who ask for truth: everything as `view` sees it. What is asked
  /// then reads `scene`, which must stay as it is until the next call. The same errors.
  void prepare(const Scene& scene, const View& view);
  /// What was prepared last, as truth.h asks for it; valid until the next call.
  [[nodiscard]] const PreparedScene& prepared() const;

 private:
  struct Work;  // What it keeps from picture to picture, of types that nobody else needs to know.
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
