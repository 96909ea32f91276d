#pragma once

#include <span>
#include <vector>

#include "flexura/model/backbone.h"

namespace flexura {

/// The surface of an arm along its backbone: the point at arc length s and angle p lies at
/// c(s) + radius(s) (cos p, sin p, 0) in the arc's frame at s.
[[nodiscard]] std::vector<Arc> tube_of(const Backbone& backbone);

/// The tube's arc that holds arc length s; the first or the last where none does. `tube`: not empty.
[[nodiscard]] const Arc& tube_arc_at(std::span<const Arc> tube, double s);

}  // namespace flexura
