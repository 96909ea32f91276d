#pragma once

#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"
#include "flexura/report/image_picture.h"

namespace flexura {

/// Returns a camera's picture for reports: outlines are drawn over it.
[[nodiscard]] ImagePlot photograph(const Picture& picture, const SensorConfig& sensor, std::string heading);

/// Returns a cross at a point of the picture, px, with arms of `size` px: for its outlines.
[[nodiscard]] ImageOutline::Line cross(const Eigen::Vector2d& at, double size);

}  // namespace flexura
