#pragma once

#include <cstdint>

#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"
#include "flexura/study/study_target.h"

namespace flexura {

/// Measures a study's target in pictures: its square, dark before a bright ground, is drawn, read out by the
/// camera's sensor (gray, 8 bits), found by its border, and its four edges are fitted with lines, the lens's
/// distortion undone. What the corners tell of the plane places the centre and the circle in the image.
class MeasuredTarget {
 public:
  /// `stream` has the seed and the camera of the pictures' noise.
  MeasuredTarget(const StudyTarget& target, const SensorConfig& sensor, const NoiseStream& stream);

  /// In picture number `frame`, whose noise is its own. Nothing where the square is not wholly in the image,
  /// or is seen from its edge. Which edge is which is told by where the formulas have them.
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
