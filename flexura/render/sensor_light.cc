#include "flexura/render/sensor_light.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace flexura {
namespace {

void take_size(const SensorConfig& sensor, Image<float>& image) {
  const int width = static_cast<int>(sensor.width), height = static_cast<int>(sensor.height);
  if (image.width() != width || image.height() != height || image.channels() != sensor.channels())
    image = Image<float>(width, height, sensor.channels());
}

// Exposes rows with a common exposure time.
void expose(const SensorConfig& sensor, double start, int instants, const DrawLight& draw, const Rows& rows,
            Image<float>& light, Image<float>& scratch) {
  if (instants == 1 || sensor.exposure == 0) {
    draw(start + 0.5 * sensor.exposure, rows, light);
    return;
  }
  for (int v = rows.first; v < rows.last; v += rows.step) std::ranges::fill(light.row(v), 0.0f);
  const float share = 1 / static_cast<float>(instants);
  for (int instant = 0; instant < instants; ++instant) {
    draw(start + sensor.exposure * (instant + 0.5) / instants, rows, scratch);
    for (int v = rows.first; v < rows.last; v += rows.step) {
      const std::span<float> sum = light.row(v);
      const std::span<const float> one = scratch.row(v);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * one[i];
    }
  }
}

}  // namespace

void gather_light(const SensorConfig& sensor, double start, int instants, const DrawLight& draw,
                  Image<float>& light, Image<float>& scratch) {
  if (instants < 1) throw std::invalid_argument("a frame needs at least one time");
  take_size(sensor, light);
  if (instants > 1) take_size(sensor, scratch);
  const int height = light.height();
  const auto expose_rows = [&](const Rows& rows) {
    expose(sensor, start + row_delay(sensor, rows.first), instants, draw, rows, light, scratch);
  };
  if (sensor.readout == Readout::global) {
    expose_rows({0, height, 1});
  } else if (sensor.readout == Readout::interlaced) {
    expose_rows({0, height, 2});
    if (height > 1) expose_rows({1, height, 2});
  } else {
    for (int v = 0; v < height; ++v) expose_rows({v, v + 1, 1});
  }
}

}  // namespace flexura
