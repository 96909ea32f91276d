#pragma once

#include <span>
#include <vector>

#include "flexura/model/backbone.h"

namespace flexura {

/// Returns the arcs of the arm's tube along a backbone. The surface point at arc length s and angle p is c(s)
/// + radius(s) (cos p, sin p, 0). Here c(s) is the backbone point, and the vector (cos p, sin p, 0) is in the
/// arc's frame at s.
[[nodiscard]] std::vector<Arc> tube_of(const Backbone& backbone);

/// Returns the arc of the tube that contains the arc length s, m. If s is outside the tube, returns the first
/// or the last arc. `tube` must not be empty.
[[nodiscard]] const Arc& tube_arc_at(std::span<const Arc> tube, double s);

}  // namespace flexura
