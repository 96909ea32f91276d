#pragma once

#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"
#include "flexura/report/image_picture.h"

namespace flexura {

/// A picture that a camera took, for reports: outlines are drawn over it.
[[nodiscard]] ImagePlot photograph(const Picture& picture, const SensorConfig& sensor, std::string heading);

/// A cross at a place of the picture, px, whose arms are `size` px long: for its outlines.
[[nodiscard]] ImageOutline::Line cross(const Eigen::Vector2d& at, double size);

}  // namespace flexura
