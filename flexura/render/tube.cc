#include "flexura/render/tube.h"

#include <algorithm>

namespace flexura {

std::vector<Arc> tube_of(const Backbone& backbone) {
  return {backbone.arcs().begin(), backbone.arcs().end()};
}

const Arc& tube_arc_at(std::span<const Arc> tube, double s) {
  const auto next = std::ranges::upper_bound(tube, s, {}, &Arc::s);
  return next == tube.begin() ? tube.front() : *(next - 1);
}

}  // namespace flexura
