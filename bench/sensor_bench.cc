#include <benchmark/benchmark.h>

#include <cstdint>

#include "flexura/render/sensor_image.h"

namespace flexura {
namespace {

// Returns the light of a slanted dark bar, a fifth of the image's width, in front of a bright screen.
Image<float> light_of(const SensorConfig& config) {
  const int width = static_cast<int>(config.width), height = static_cast<int>(config.height);
  Image<float> light(width, height, config.channels(), 0.8f);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const float across =
          (static_cast<float>(u) - 0.3f * static_cast<float>(width) - 0.3f * static_cast<float>(v)) /
          (0.2f * static_cast<float>(width));
      if (across < 0 || across > 1) continue;
      for (int channel = 0; channel < config.channels(); ++channel)
        light.at(u, v, channel) = 0.1f + across * (1 - across);
    }
  }
  return light;
}

void read(benchmark::State& state, const SensorConfig& config, SimdPath path = best_simd_path()) {
  const Sensor sensor(config, path);
  const Image<float> light = light_of(config);
  SensorRows rows;
  Image<std::uint8_t> image;
  std::uint64_t frame = 0;
  for (auto _ : state) {
    sensor.read(light, {1, 0, frame++}, rows, image);
    benchmark::DoNotOptimize(image.values().data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * config.width * config.height);
}

constexpr SensorConfig plain = {};
constexpr SensorConfig noisy = {.full_well = 10000, .read_noise = 1.5};
constexpr SensorConfig blurred = {.psf = 0.7};
constexpr SensorConfig both = {.full_well = 10000, .read_noise = 1.5, .psf = 0.7};
constexpr SensorConfig color = {
    .pixels = PixelKind::color, .full_well = 10000, .read_noise = 1.5, .psf = 0.7};
constexpr SensorConfig wide = {
    .width = 1920, .height = 1080, .full_well = 10000, .read_noise = 1.5, .psf = 0.7};
constexpr SensorConfig everything = {
    .full_well = 10000, .read_noise = 1.5, .psf = 0.7, .vignetting = 0.2, .gamma = 2.2};
BENCHMARK_CAPTURE(read, plain, plain);
BENCHMARK_CAPTURE(read, noise, noisy);
BENCHMARK_CAPTURE(read, psf, blurred);
BENCHMARK_CAPTURE(read, psf_and_noise, both);
BENCHMARK_CAPTURE(read, psf_and_noise_color, color);
BENCHMARK_CAPTURE(read, psf_and_noise_1920x1080, wide);
BENCHMARK_CAPTURE(read, vignetting_psf_noise_gamma, everything);
BENCHMARK_CAPTURE(read, psf_and_noise_baseline, both, SimdPath::baseline);

}  // namespace
}  // namespace flexura
