#include "flexura/render/renderer.h"

#include <algorithm>
#include <limits>

#include "flexura/render/cell.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/quick_picture.h"
#include "flexura/render/screen_pixels.h"
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

// Draws a pixel by the reference path.
void render_pixel(const PreparedScene& prepared, int u, int v, PixelKind pixels, LightImage& picture) {
  const Stage& stage = prepared.stage;
  const auto parts = prepared.tiles.parts(u / Tiles::size, v / Tiles::size);
  const Tracer tracer(stage, parts);
  const auto ray = prepared.rays.ray(u, v);
  if (parts.empty() || !ray) {
    store(stage.scene->background, u, v, pixels, picture.light);
    picture.depth.at(u, v) = std::numeric_limits<float>::infinity();
    return;
  }
  const Trace here = tracer.trace(*ray);
  Color sum = Color::Zero();
  cover(tracer, *ray, {0, 0}, 0.5, 0, here,
        [&](const Hit& hit, const Ray& at, double area) { sum += area * light_of(stage, hit, at); });
  store(sum, u, v, pixels, picture.light);
  picture.depth.at(u, v) = static_cast<float>(here.hit.depth);
}

bool shows_only_screens(const PreparedScene& prepared, int u, int v) {
  return std::ranges::all_of(prepared.tiles.parts(u / Tiles::size, v / Tiles::size), [&](const Part& part) {
    return part.kind == Part::Kind::face && prepared.stage.faces[part.index].screen >= 0;
  });
}

}  // namespace

struct Renderer::Work {
  explicit Work(SimdPath path) : quick(path) {}

  PreparedScene prepared;
  QuickPicture quick;
  ScreenPixels screens;
};

Renderer::Renderer(SimdPath path) : work_(std::make_unique<Work>(path)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const PreparedScene& Renderer::prepared() const { return work_->prepared; }

void Renderer::prepare(const Scene& scene, const View& view) {
  check(scene);
  check_camera(view.X_WC);
  PreparedScene& to = work_->prepared;
  to.view = view;
  to.rays.set(view.lens, view.width, view.height);
  build_stage(scene, view.X_WC, to.rays.largest_step(), to.stage);
  to.tiles.build(to.stage, to.rays);
}

void Renderer::render(const Scene& scene, const View& view, PixelKind pixels, LightImage& picture,
                      bool is_exact) {
  prepare(scene, view);
  fit(view.width, view.height, pixels == PixelKind::gray ? 1 : 3, picture.light);
  fit(view.width, view.height, 1, picture.depth);
  const PreparedScene& prepared = work_->prepared;
  QuickPicture& quick = work_->quick;
  if (!is_exact && quick.draw(prepared.stage, prepared.rays, view.lens.intrinsics(), pixels, picture)) {
    ScreenPixels& screens = work_->screens;
    screens.begin(scene, view, pixels);
    const int channels = picture.light.channels();
    for (const auto& [u, v] : quick.left_out()) {
      if (!shows_only_screens(prepared, u, v)) {
        render_pixel(prepared, u, v, pixels, picture);
        continue;
      }
      if (const ScreenPixels::Pixel* known = screens.find(u, v)) {
        picture.depth.at(u, v) = known->depth;
        for (int c = 0; c < channels; ++c) picture.light.at(u, v, c) = known->light[c];
        continue;
      }
      render_pixel(prepared, u, v, pixels, picture);
      ScreenPixels::Pixel pixel{.u = u, .v = v, .depth = picture.depth.at(u, v)};
      for (int c = 0; c < channels; ++c) pixel.light[c] = picture.light.at(u, v, c);
      screens.add(pixel);
    }
    screens.end();
    return;
  }
  for (int v = 0; v < view.height; ++v)
    for (int u = 0; u < view.width; ++u) render_pixel(prepared, u, v, pixels, picture);
}

}  // namespace flexura
