#pragma once

#include <optional>
#include <span>
#include <string>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"

namespace flexura {

/// Returns what may be wrong in the description of the arm, as far as the pictures show it. For a known arm
/// that was found, the hint gives the observed radius if the arm looks much thicker or thinner than
/// described. For a known arm that was not found, the hint names a camera whose back is towards the base. Or
/// it names the picture in which the base is far from all observed points. Empty if the base is near these
/// points or outside the picture, in each picture. Also empty for arms without a radius that were found.
[[nodiscard]] std::optional<std::string> hint_of(const ShapePrior& prior,
                                                 std::span<const Observation> observations,
                                                 const ShapeEstimate& estimate);

}  // namespace flexura
