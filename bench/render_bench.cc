#include <benchmark/benchmark.h>

#include <cstdint>
#include <numbers>

#include "flexura/model/backbone.h"
#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"

namespace flexura {
namespace {

// An arm of 1 m in three sections, 2 cm thick from its middle, with twelve rings, before a white screen; it
// covers a fifth of the image.
struct Setting {
  Scene scene;
  View view;
};

Setting setting(int width, int height) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  ArmState state = ArmState::straight(3);
  constexpr double bends[3][2] = {{1.5, 0.1}, {2.0, -0.2}, {2.0, 0.2}};
  for (std::size_t i = 0; i < 3; ++i) {
    Section& section = arm.sections.emplace_back();
    section.length = 1.0 / 3;
    section.radius = {0.02, 0.02};
    state.bends[i] = {bends[i][0], bends[i][1]};
  }
  Setting result;
  result.scene.arm.tube = tube_of(arm, Backbone(arm, state));
  for (int i = 0; i < 12; ++i) {
    const double s = (i + 0.5) / 12;
    result.scene.arm.markers.push_back({s - 0.008, s + 0.008});
  }
  Screen& screen = result.scene.screens.emplace_back();
  screen.X_WS.position = {0, 0.4, -0.5};
  screen.size = {4, 4};
  // From +Z along -Z: x to the right, y down.
  result.view.X_WC.rotation << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  result.view.X_WC.position = {0.19, 0.054, 1.5};
  result.view.width = width, result.view.height = height;
  const double focal = 3.85 * height;
  result.view.lens = Lens({focal, focal, 0.5 * (width - 1), 0.5 * (height - 1)});
  return result;
}

double covered_share(const Image<float>& depth) {
  double count = 0;
  for (const float one : depth.values()) count += one < 1.9f ? 1 : 0;
  return count / static_cast<double>(depth.values().size());
}

void render(benchmark::State& state, int width, int height, PixelKind pixels) {
  const Setting it = setting(width, height);
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

BENCHMARK_CAPTURE(render, gray_640x480, 640, 480, PixelKind::gray);
BENCHMARK_CAPTURE(render, color_640x480, 640, 480, PixelKind::color);
BENCHMARK_CAPTURE(render, gray_1920x1080, 1920, 1080, PixelKind::gray);
BENCHMARK_CAPTURE(render_and_read, psf_and_noise_640x480, 640, 480);
BENCHMARK_CAPTURE(render_and_read, psf_and_noise_1920x1080, 1920, 1080);

}  // namespace
}  // namespace flexura
