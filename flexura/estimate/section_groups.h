#pragma once

#include <cstddef>

#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Returns the prior of an arm with at most `most` sections, each of which replaces neighbouring sections of
/// the prior's arm. The sections of a group share one curvature. A profile of the bend along a section is
/// left out.
[[nodiscard]] ShapePrior with_grouped_sections(const ShapePrior& prior, std::size_t most);

/// Converts `grouped`, a shape of the arm with at most `most` sections, into a shape of the prior's arm with
/// the same curve.
[[nodiscard]] Shape without_groups(const ShapePrior& prior, const Shape& grouped, std::size_t most);

}  // namespace flexura
