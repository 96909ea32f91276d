#pragma once

#include <span>
#include <vector>

#include "flexura/model/backbone.h"

namespace flexura {

/// Returns the surface of an arm along its backbone. The point at arc length s and angle p is c(s) +
/// radius(s) (cos p, sin p, 0) in the arc's frame at s.
[[nodiscard]] std::vector<Arc> tube_of(const Backbone& backbone);

/// Returns the tube's arc that contains arc length s, or the first or last one if s is outside. `tube` must
/// not be empty.
[[nodiscard]] const Arc& tube_arc_at(std::span<const Arc> tube, double s);

}  // namespace flexura
