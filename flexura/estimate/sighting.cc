#include "flexura/estimate/sighting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/math/so3.h"

namespace flexura {

View corrected(View view, const ViewError& error) {
  view.X_WC.rotation *= so3_exp(error.turn);
  if (error.focal == 0) return view;
  Intrinsics lens = view.lens.intrinsics();
  lens.fx *= std::exp(error.focal), lens.fy *= std::exp(error.focal);
  view.lens = Lens(lens);
  return view;
}

Sighting reversed(Sighting sighting) {
  std::ranges::reverse(sighting.points);
  std::swap(sighting.ends[0], sighting.ends[1]);
  for (SeenBand& band : sighting.bands) band.heading = -band.heading;
  return sighting;
}

Sighting thinned(const Sighting& sighting, std::size_t most) {
  const std::size_t count = sighting.points.size();
  if (count <= most || most < 2) return sighting;
  Sighting thin{sighting.view, {}, sighting.ends, sighting.markers, sighting.bands,
                sighting.doubt};
  for (std::size_t i = 0; i < most; ++i) thin.points.push_back(sighting.points[i * (count - 1) / (most - 1)]);
  return thin;
}

}  // namespace flexura
