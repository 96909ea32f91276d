#pragma once

#include <cstdint>

#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"
#include "flexura/study/study_target.h"

namespace flexura {

/// Measures a study's target in rendered pictures. A picture shows the target's square, dark on a bright
/// background, with the effects of the camera's sensor (gray, 8 bits). The square is found by its border.
/// After correction of the lens's distortion, lines are fitted to the four edges. The resulting corners
/// determine the homography of the target's plane, which gives the centre and the circle in the image.
class MeasuredTarget {
 public:
  /// `stream` determines the noise of the pictures by a seed and a camera index.
  MeasuredTarget(const StudyTarget& target, const SensorConfig& sensor, const NoiseStream& stream);

  /// Measures the target in picture number `frame`. Each picture has independent noise. The result has no
  /// points if the square is not entirely in the image, or if the camera is in the square's plane. The edges
  /// are identified by their positions from the projection formulas.
  [[nodiscard]] TargetImage image(const View& view, std::uint64_t frame);

 private:
  const StudyTarget& target_;
  Sensor sensor_;
  NoiseStream stream_;
  Scene scene_;
  Renderer renderer_;
  LightImage light_;
  SensorRows rows_;
  Image<std::uint8_t> picture_;
};

}  // namespace flexura
