#include "flexura/experiment/photographer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <variant>

#include "flexura/render/sensor_light.h"

namespace flexura {
namespace {

// How many instants an exposure is made of: enough that between two of them nothing that the arm shows moves
// by more than half a pixel, as far as that is no more than `most`.
int instants_of(const Shot& shot) {
  constexpr double largest_step = 0.5;  // px
  constexpr int most = 64;
  if (shot.sensor->exposure <= 0) return 1;
  const double end = shot.start + shot.sensor->exposure;
  const View at_start = shot.view(shot.start), at_end = shot.view(end);
  const Backbone arm_at_start = shot.backbone(shot.start), arm_at_end = shot.backbone(end);
  double farthest = 0;
  const auto compare = [&](const Pose& X_WA, const Pose& X_WB) {
    const auto from = at_start.project(X_WA.position), to = at_end.project(X_WB.position);
    if (from && to) farthest = std::max(farthest, (*to - *from).norm());
  };
  for (std::size_t i = 0; i < arm_at_start.arcs().size(); ++i)
    compare(arm_at_start.arcs()[i].X_WS, arm_at_end.arcs()[i].X_WS);
  compare(arm_at_start.tip(), arm_at_end.tip());
  return static_cast<int>(std::clamp(std::ceil(farthest / largest_step), 1.0, static_cast<double>(most)));
}

}  // namespace

Photographer::Photographer(const Arm& arm, const Experiment& experiment)
    : maker_(arm, experiment.arm.look, experiment.stand, experiment.obstacle) {}

const Sensor& Photographer::sensor(const Shot& shot) {
  const auto found = sensors_.find(shot.camera);
  return found != sensors_.end() ? found->second : sensors_.emplace(shot.camera, *shot.sensor).first->second;
}

Picture Photographer::take(const Shot& shot) {
  const SensorConfig& config = *shot.sensor;
  const DrawLight draw = [&](double time, const Rows& rows, Image<float>& light) {
    renderer_.render(maker_.scene(shot.backbone(time)), shot.view(time), config.pixels, instant_);
    for (int v = rows.first; v < rows.last; v += rows.step)
      std::ranges::copy(instant_.light.row(v), light.row(v).begin());
  };
  gather_light(config, shot.start, instants_of(shot), draw, light_, scratch_);
  const NoiseStream stream{shot.seed, shot.camera, static_cast<std::uint64_t>(shot.frame)};
  const auto read = [&]<typename Value>(Image<Value> image) -> Picture {
    sensor(shot).read(light_, stream, rows_, image);
    return image;
  };
  const auto width = static_cast<int>(config.width), height = static_cast<int>(config.height);
  if (config.bits <= 8) return read(Image<std::uint8_t>(width, height, light_.channels()));
  return read(Image<std::uint16_t>(width, height, light_.channels()));
}

}  // namespace flexura
