#pragma once

#include <memory>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_features.h"

namespace flexura {

/// What a stretch of 1 counts as among features in px (about what a section's end moves by then), and in rad.
inline constexpr double stretch_px = 100, stretch_rad = 1;

/// The same features, and beside them each section's stretch as the pictures tell it, a stretch of 1 as
/// `weight` in the features' unit: for those that say little of lengths (angles nothing at all) where the arm
/// can change its own. Those of an arm that cannot are given back as they are.
[[nodiscard]] std::unique_ptr<ServoFeatures> with_lengths(std::unique_ptr<ServoFeatures> features,
                                                          const Arm& arm, double weight);

}  // namespace flexura
