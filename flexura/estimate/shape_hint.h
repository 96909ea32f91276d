#pragma once

#include <optional>
#include <span>
#include <string>

#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/sighting.h"

namespace flexura {

/// What may be wrong with that which was said of the arm, as far as the pictures tell: of a known arm that is
/// found, that it is seen much thicker or thinner than it is described, and what radius is seen (none of arms
/// without a radius); of one that is not found, behind which camera its base is, or in which picture it would
/// be seen far from all that is seen (none where it is near in all, or beside them).
[[nodiscard]] std::optional<std::string> hint_of(const ShapePrior& prior, std::span<const Sighting> sightings,
                                                 const ShapeEstimate& estimate);

}  // namespace flexura
