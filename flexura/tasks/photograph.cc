#include "flexura/tasks/photograph.h"

#include <cstdint>
#include <utility>

#include "flexura/base/bytes.h"
#include "flexura/picture/image_file.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {

ImagePlot photograph(const Picture& picture, const SensorConfig& sensor, std::string heading) {
  const Image<std::uint8_t> shown = eight_bits(picture, sensor.white());
  return {.heading = std::move(heading),
          .legend = "",
          .width = shown.width(),
          .height = shown.height(),
          .outlines = {},
          .background = "data:image/jpeg;base64," + base64(jpeg(shown))};
}

ImageOutline::Line cross(const Eigen::Vector2d& at, double size) {
  const Eigen::Vector2d x(size, 0), y(0, size);
  return {{at - x, at + x, at, at - y, at + y}, ""};
}

}  // namespace flexura
