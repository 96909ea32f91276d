#pragma once

#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"
#include "flexura/report/image_picture.h"

namespace flexura {

/// Returns a plot for reports with a camera's picture, over which outlines can be drawn.
[[nodiscard]] ImagePlot photograph(const Picture& picture, const SensorConfig& sensor, std::string heading);

/// Returns a cross at the pixel `at` for use in an outline. Each of its four arms is `size` px long.
[[nodiscard]] ImageOutline::Line cross(const Eigen::Vector2d& at, double size);

}  // namespace flexura
