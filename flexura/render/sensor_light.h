#pragma once

#include <functional>

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"

namespace flexura {

/// The rows first, first + step, ..., below last.
struct Rows {
  int first = 0, last = 0, step = 1;
};

/// Function that draws rows of the light on the image plane at a time, s, into an image of the sensor's size.
/// Other rows remain unchanged.
using DrawLight = std::function<void(double time, const Rows& rows, Image<float>& light)>;

/// Computes the light of a frame that starts at `start`, s. The light of a row is the mean over `instants`
/// times in the row's exposure. These times are the middles of equal parts of the exposure. If the exposure
/// is 0, the only time is its start. `light` is resized to the sensor's size; `scratch` is used if several
/// times are averaged. For each time, draws once for a global shutter, twice for interlaced readout, and row
/// by row for a rolling shutter. Throws std::invalid_argument for instants < 1.
void gather_light(const SensorConfig& sensor, double start, int instants, const DrawLight& draw,
                  Image<float>& light, Image<float>& scratch);

}  // namespace flexura
