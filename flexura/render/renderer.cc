#include "flexura/render/renderer.h"

#include <limits>

#include "flexura/render/cell.h"
#include "flexura/render/tracer.h"

namespace flexura {
namespace {

void store(const Color& light, int u, int v, PixelKind pixels, Image<float>& image) {
  if (pixels == PixelKind::gray) {
    image.at(u, v) = static_cast<float>(gray_of(light));
    return;
  }
  for (int channel = 0; channel < 3; ++channel) image.at(u, v, channel) = static_cast<float>(light[channel]);
}

void fit(int width, int height, int channels, Image<float>& image) {
  if (image.width() == width && image.height() == height && image.channels() == channels) return;
  image = Image<float>(width, height, channels);
}

}  // namespace

void Renderer::prepare(const Scene& scene, const View& view) {
  check(scene);
  check_camera(view.X_WC);
  view_ = view;
  rays_.set(view.lens, view.width, view.height);
  build_stage(scene, view.X_WC, rays_.largest_step(), stage_);
  tiles_.build(stage_, rays_);
}

void Renderer::render_pixel(int u, int v, PixelKind pixels, LightImage& picture) const {
  const auto parts = tiles_.parts(u / Tiles::size, v / Tiles::size);
  const Tracer tracer(stage_, parts);
  const auto ray = rays_.ray(u, v);
  if (parts.empty() || !ray) {
    store(stage_.scene->background, u, v, pixels, picture.light);
    picture.depth.at(u, v) = std::numeric_limits<float>::infinity();
    return;
  }
  const Trace here = tracer.trace(*ray);
  Color sum = Color::Zero();
  cover(tracer, *ray, {0, 0}, 0.5, 0, here,
        [&](const Hit& hit, const Ray& at, double area) { sum += area * light_of(stage_, hit, at); });
  store(sum, u, v, pixels, picture.light);
  picture.depth.at(u, v) = static_cast<float>(here.hit.depth);
}

void Renderer::render(const Scene& scene, const View& view, PixelKind pixels, LightImage& picture,
                      bool is_exact) {
  prepare(scene, view);
  fit(view.width, view.height, pixels == PixelKind::gray ? 1 : 3, picture.light);
  fit(view.width, view.height, 1, picture.depth);
  if (!is_exact && quick_.draw(stage_, rays_, view.lens.intrinsics(), pixels, picture)) {
    for (const QuickPicture::Pixel& pixel : quick_.left_out())
      render_pixel(pixel.u, pixel.v, pixels, picture);
    return;
  }
  for (int v = 0; v < view.height; ++v)
    for (int u = 0; u < view.width; ++u) render_pixel(u, v, pixels, picture);
}

}  // namespace flexura
