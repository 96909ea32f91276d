#include "flexura/estimate/sighting.h"

#include <algorithm>
#include <utility>

namespace flexura {

Sighting reversed(Sighting sighting) {
  std::ranges::reverse(sighting.points);
  std::swap(sighting.ends[0], sighting.ends[1]);
  for (SeenBand& band : sighting.bands) band.heading = -band.heading;
  return sighting;
}

Sighting thinned(const Sighting& sighting, std::size_t most) {
  const std::size_t count = sighting.points.size();
  if (count <= most || most < 2) return sighting;
  Sighting thin{sighting.view, {}, sighting.ends, sighting.markers, sighting.bands};
  for (std::size_t i = 0; i < most; ++i) thin.points.push_back(sighting.points[i * (count - 1) / (most - 1)]);
  return thin;
}

}  // namespace flexura
