#pragma once

#include <cstddef>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Increases the standard deviation of the observed tip, `seen.ends[1]`, if the image of the predicted tip is
/// nearer to the image of the arm's earlier parts than the tube's radius. The camera then sees the tip nearly
/// end-on, or the tip is in front of or behind the arm. The end of the silhouette then belongs to the rim of
/// the tube or to a fold. `observation`: index that selects the view error of this observation in
/// `predicted`. Arms without a radius are not changed.
void distrust_hidden_tip(const Shape& predicted, std::size_t observation, Observation& seen);

}  // namespace flexura
