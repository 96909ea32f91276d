#pragma once

#include <memory>

#include "flexura/model/arm.h"
#include "flexura/servo/servo_features.h"

namespace flexura {

/// The same features, and beside them each section's stretch as the pictures tell it, as 100 px for a stretch
/// of 1: for those that say little of lengths (angles nothing at all) where the arm can change its own. Those
/// of an arm that cannot are given back as they are.
[[nodiscard]] std::unique_ptr<ServoFeatures> with_lengths(std::unique_ptr<ServoFeatures> features,
                                                          const Arm& arm);

}  // namespace flexura
