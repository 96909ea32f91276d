#pragma once

#include <vector>

#include "flexura/model/backbone.h"

namespace flexura {

/// Arc lengths, m, rising from 0 to backbone.length(), every section's ends among them, such that the
/// polyline through the backbone's points there stays within `tolerance` m of the exact arcs; each arc is cut
/// into the fewest equal pieces that do, none of more than a quarter turn (a coarse drawing still shows the
/// bends). std::invalid_argument for a tolerance below 1e-12 of the length, or not a number.
[[nodiscard]] std::vector<double> sample_arc_lengths(const Backbone& backbone, double tolerance);

}  // namespace flexura
