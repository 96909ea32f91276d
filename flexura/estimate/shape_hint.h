#pragma once

#include <optional>
#include <span>
#include <string>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"

namespace flexura {

/// Returns what may be wrong in the description of the arm, as far as the pictures show it. For a known arm
/// that was found: that it looks much thicker or thinner than described, with the observed radius (not for
/// arms without a radius). For one that was not found: the camera that has the base behind it, or the picture
/// in which the base is far from all observed points. Empty if, in each picture, the base is near these
/// points or outside.
[[nodiscard]] std::optional<std::string> hint_of(const ShapePrior& prior,
                                                 std::span<const Observation> observations,
                                                 const ShapeEstimate& estimate);

}  // namespace flexura
