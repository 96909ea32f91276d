#pragma once

#include <functional>

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"

namespace flexura {

/// Rows first, first + step, ... below last.
struct Rows {
  int first = 0, last = 0, step = 1;
};

/// Draws rows of the light on the image plane at an instant, s, into an image of the sensor's size, and
/// leaves the other rows unchanged.
using DrawLight = std::function<void(double time, const Rows& rows, Image<float>& light)>;

/// Computes the light of a frame that begins at `start`, s. Each row is the mean over `instants` instants of
/// its exposure, in the middle of as many equal parts (at its beginning if the exposure is 0). `light` takes
/// the sensor's size; `scratch` is used if several instants are averaged. Draws once per instant with a
/// global shutter, twice with an interlaced one, and row by row with a rolling one. Throws
/// std::invalid_argument for fewer than 1 instant.
void gather_light(const SensorConfig& sensor, double start, int instants, const DrawLight& draw,
                  Image<float>& light, Image<float>& scratch);

}  // namespace flexura
