#pragma once

#include <optional>
#include <span>
#include <string>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"

namespace flexura {

/// Returns a hint about a possible error in the descriptions of arm and cameras. For a known arm that was
/// found, the hint states the observed radius if the arm looks much thicker or thinner than described. For a
/// known arm that was not found, the hint names a camera or a picture. The camera has the base behind it, or
/// the base is far from all observed points in the picture. For an arm of known length that was not found,
/// the hint states the observed length if it differs, and the unit in which lengths were probably given.
/// Returns std::nullopt if no error is visible.
[[nodiscard]] std::optional<std::string> hint_of(const ShapePrior& prior,
                                                 std::span<const Observation> observations,
                                                 const ShapeEstimate& estimate);

}  // namespace flexura
