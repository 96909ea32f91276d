#include <benchmark/benchmark.h>

#include <cstdint>

#include "bench/render_scene.h"
#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"

namespace flexura {
namespace {

void render(benchmark::State& state, const Setting& it, PixelKind pixels) {
  Renderer renderer;
  LightImage picture;
  for (auto _ : state) {
    renderer.render(it.scene, it.view, pixels, picture);
    benchmark::DoNotOptimize(picture.light.values().data());
    benchmark::ClobberMemory();
  }
  state.counters["covered"] = covered_share(picture.depth);
  state.SetItemsProcessed(state.iterations());
}

void render_and_read(benchmark::State& state, int width, int height) {
  const Setting it = setting(width, height);
  const Sensor sensor({.width = width, .height = height, .full_well = 10000, .read_noise = 1.5, .psf = 0.7});
  Renderer renderer;
  LightImage picture;
  SensorRows rows;
  Image<std::uint8_t> image;
  std::uint64_t frame = 0;
  for (auto _ : state) {
    renderer.render(it.scene, it.view, PixelKind::gray, picture);
    sensor.read(picture.light, {1, 0, frame++}, rows, image);
    benchmark::DoNotOptimize(image.values().data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(render, gray_640x480, setting(640, 480), PixelKind::gray);
BENCHMARK_CAPTURE(render, color_640x480, setting(640, 480), PixelKind::color);
BENCHMARK_CAPTURE(render, gray_1920x1080, setting(1920, 1080), PixelKind::gray);
BENCHMARK_CAPTURE(render, laboratory_gray_640x480, laboratory_setting(640, 480), PixelKind::gray);
BENCHMARK_CAPTURE(render, laboratory_color_640x480, laboratory_setting(640, 480), PixelKind::color);
BENCHMARK_CAPTURE(render, tapered_laboratory_gray_640x480, laboratory_setting(640, 480, 0.6),
                  PixelKind::gray);
BENCHMARK_CAPTURE(render_and_read, psf_and_noise_640x480, 640, 480);
BENCHMARK_CAPTURE(render_and_read, psf_and_noise_1920x1080, 1920, 1080);

}  // namespace
}  // namespace flexura
