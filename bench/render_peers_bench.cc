// Compares other renderers with Flexura's on one scene. Each draws 640x480 pixels and copies them into main
// memory. CPU times are totals of all threads of the process; only one thread runs unless the name states
// otherwise.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>

#include "bench/embree_peer.h"
#include "bench/llvmpipe_peer.h"
#include "bench/mujoco_peer.h"
#include "bench/peer.h"
#include "bench/render_scene.h"
#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"

namespace flexura {
namespace {

constexpr int width = 640, height = 480;

// Flexura's renderer: light and depth, and with `is_read` also the sensor's 8-bit image.
class OurPeer final : public Peer {
 public:
  OurPeer(const Setting& setting, const SensorConfig& sensor, bool is_read)
      : setting_(setting), sensor_(sensor), is_read_(is_read) {}

  void draw() override {
    renderer_.render(setting_.scene, setting_.view, sensor_.config().pixels, picture_);
    if (is_read_) sensor_.read(picture_.light, {1, 0, frame_++}, rows_, image_);
    benchmark::ClobberMemory();
  }

  PeerPicture picture() override {
    draw();
    if (!is_read_) sensor_.read(picture_.light, {1, 0, 0}, rows_, image_);
    return {image_, picture_.depth};
  }

 private:
  Setting setting_;
  Sensor sensor_;
  bool is_read_;
  Renderer renderer_;
  LightImage picture_;
  SensorRows rows_;
  Image<std::uint8_t> image_;
  std::uint64_t frame_ = 0;
};

double light_at(const Image<std::uint8_t>& pixels, int u, int v) {
  if (pixels.channels() == 1) return pixels.at(u, v) / 255.0;
  return gray_of(Color(pixels.at(u, v, 0), pixels.at(u, v, 1), pixels.at(u, v, 2)) / 255.0);
}

// How closely a peer's frame matches Flexura's.
struct Likeness {
  double covered_by_depth = 0, covered_by_light = 0;  // Covered share of the pixels, relative to Flexura's.
  double equal_depth = 0, equal_light = 0;  // Share of equal pixels: to 2 mm; to 0.03 of full scale.

  [[nodiscard]] bool is_one_scene() const {
    return std::abs(covered_by_depth - 1) < 0.03 && std::abs(covered_by_light - 1) < 0.03 &&
           equal_depth > 0.97 && equal_light > 0.95;
  }
};

Likeness likeness(const PeerPicture& peer, const Setting& setting) {
  LightImage ours;
  Renderer().render(setting.scene, setting.view, PixelKind::gray, ours);
  int light_count = 0, our_light_count = 0, depths = 0, lights = 0;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double light = light_at(peer.pixels, u, v);
      // The screen's light is 0.85, that of the arm and its rings below 0.25.
      light_count += light < 0.5 ? 1 : 0;
      our_light_count += ours.light.at(u, v) < 0.5f ? 1 : 0;
      depths += std::abs(peer.depth.at(u, v) - ours.depth.at(u, v)) < 0.002f ? 1 : 0;
      lights += std::abs(light - ours.light.at(u, v)) < 0.03 ? 1 : 0;
    }
  }
  constexpr double pixels = width * height;
  return {covered_share(peer.depth) / covered_share(ours.depth),
          static_cast<double>(light_count) / our_light_count, depths / pixels, lights / pixels};
}

template <typename MakePeer>
void measure(const std::string& name, MakePeer make_peer) {
  const auto run = [make_peer](benchmark::State& state) {
    try {
      const Setting scene = setting(width, height);
      const std::unique_ptr<Peer> peer = make_peer(scene);
      const Likeness like = likeness(peer->picture(), scene);
      if (!like.is_one_scene()) state.SkipWithError("not the same picture as ours");
      for (auto _ : state) peer->draw();
      state.counters["covered_by_depth"] = like.covered_by_depth;
      state.counters["covered_by_light"] = like.covered_by_light;
      state.counters["equal_depth"] = like.equal_depth;
      state.counters["equal_light"] = like.equal_light;
      state.SetItemsProcessed(state.iterations());
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  };
  benchmark::RegisterBenchmark(name.c_str(), run)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}

void measure_ours(const std::string& name, const SensorConfig& sensor, bool is_read) {
  measure(name, [=](const Setting& scene) { return std::make_unique<OurPeer>(scene, sensor, is_read); });
}

void measure_llvmpipe(const std::string& name, LlvmpipeConfig config) {
  measure("llvmpipe/" + name, [=](const Setting& scene) { return llvmpipe_peer(scene, config); });
}

void measure_mujoco(const std::string& name, MujocoConfig config) {
  measure("mujoco/" + name, [=](const Setting& scene) { return mujoco_peer(scene, config); });
}

void measure_embree(const std::string& name, EmbreeShape shape, int rays_across) {
  measure("embree/" + name, [=](const Setting& scene) { return embree_peer(scene, shape, rays_across); });
}

// Lower bound for any renderer: writes all pixels.
template <typename Value, int channels>
void write(benchmark::State& state) {
  Image<Value> pixels(width, height, channels);
  Image<float> depth(width, height);
  for (auto _ : state) {
    std::ranges::fill(pixels.values(), static_cast<Value>(1));
    std::ranges::fill(depth.values(), 2.0f);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(write<std::uint8_t, 1>)->Name("write/gray_bytes_and_depth")->Unit(benchmark::kMillisecond);
BENCHMARK(write<float, 1>)->Name("write/gray_light_and_depth")->Unit(benchmark::kMillisecond);
BENCHMARK(write<float, 3>)->Name("write/color_light_and_depth")->Unit(benchmark::kMillisecond);

void measure_all() {
  const SensorConfig gray{.width = width, .height = height};
  const SensorConfig noisy{
      .width = width, .height = height, .full_well = 10000, .read_noise = 1.5, .psf = 0.7};
  const SensorConfig color{.width = width, .height = height, .pixels = PixelKind::color};
  measure_ours("ours/gray_light_depth", gray, false);
  measure_ours("ours/gray_bytes_depth", gray, true);
  measure_ours("ours/gray_bytes_depth_psf_noise", noisy, true);
  measure_ours("ours/color_light_depth", color, false);
  for (const int samples : {0, 4}) {
    const std::string more = samples > 0 ? "_msaa" + std::to_string(samples) : "";
    measure_llvmpipe("color" + more, {.samples = samples});
    measure_llvmpipe("color_depth" + more, {.samples = samples, .reads_depth = true});
    measure_llvmpipe("gray_depth" + more,
                     {.samples = samples, .pixels = PixelKind::gray, .reads_depth = true});
    measure_llvmpipe("color_depth" + more + "_default_threads",
                     {.samples = samples, .reads_depth = true, .threads = LlvmpipeThreads::as_it_comes});
    measure_mujoco("color_depth" + more, {.samples = samples});
    // As many sides as the triangle mesh, and so few stacks that nothing visible changes.
    measure_mujoco("color_depth_coarse" + more, {.samples = samples, .slices = 24, .stacks = 4});
  }
  measure_embree("gray_depth_triangles", EmbreeShape::triangles, 1);
  measure_embree("gray_depth_triangles_4_rays", EmbreeShape::triangles, 2);
  measure_embree("gray_depth_curves", EmbreeShape::curves, 1);
}

}  // namespace
}  // namespace flexura

int main(int count, char** values) {
  flexura::measure_all();
  benchmark::Initialize(&count, values);
  if (benchmark::ReportUnrecognizedArguments(count, values)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
