#pragma once

#include <cstdint>

#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/render/renderer.h"
#include "flexura/render/sensor_image.h"
#include "flexura/study/study_target.h"

namespace flexura {

/// Measures a study's target in pictures. Its square, dark on a bright background, is rendered, read out by
/// the camera's sensor (gray, 8 bits) and found by its border. Its four edges are fitted with lines, with the
/// lens's distortion removed. The corners define the plane, which gives the centre and the circle in the
/// image.
class MeasuredTarget {
 public:
  /// `stream` has the seed and the camera of the pictures' noise.
  MeasuredTarget(const StudyTarget& target, const SensorConfig& sensor, const NoiseStream& stream);

  /// Returns the target in picture number `frame`, with independent noise. Empty if the square is not
  /// entirely in the image, or is seen edge-on. The positions by the formulas identify the edges.
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
