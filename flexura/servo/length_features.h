#pragma once

#include <memory>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_features.h"

namespace flexura {

/// Weight of a stretch of 1 among features in px and among features in rad. The weight in px is approximately
/// the image motion of a section's end.
inline constexpr double stretch_px = 100, stretch_rad = 1;

/// Returns `features` extended by each section's stretch as estimated from the pictures. A stretch of 1
/// counts as `weight` in the features' unit. Use this function for features that depend little or not at all
/// on lengths, such as angles. If the arm cannot stretch, returns `features` unchanged.
[[nodiscard]] std::unique_ptr<ServoFeatures> with_lengths(std::unique_ptr<ServoFeatures> features,
                                                          const Arm& arm, double weight);

}  // namespace flexura
