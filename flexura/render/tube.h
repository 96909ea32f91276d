#pragma once

#include <span>
#include <vector>

#include "flexura/model/backbone.h"

namespace flexura {

/// Returns the arcs of the arm's tube along a backbone. With the backbone point c(s), the surface point at
/// arc length s and angle p is c(s) + radius(s) (cos p, sin p, 0). This vector is in the arc's frame at s.
[[nodiscard]] std::vector<Arc> tube_of(const Backbone& backbone);

/// Returns the arc of the tube that contains arc length s, m; the first or last arc if s is outside. `tube`
/// must not be empty.
[[nodiscard]] const Arc& tube_arc_at(std::span<const Arc> tube, double s);

}  // namespace flexura
