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

bool are_enough(std::span<const Sighting> sightings) {
  constexpr std::size_t fewest = 4;
  const auto has_axis = [](const Sighting& seen) { return seen.points.size() >= fewest; };
  const auto is_seen = [&](const Sighting& seen) {
    return has_axis(seen) || seen.borders.size() >= 2 * fewest;
  };
  return std::ranges::any_of(sightings, has_axis) && std::ranges::all_of(sightings, is_seen);
}

Sighting reversed(Sighting sighting) {
  std::ranges::reverse(sighting.points);
  std::swap(sighting.ends[0], sighting.ends[1]);
  std::swap(sighting.edges[0], sighting.edges[1]);
  for (auto& edge : sighting.edges) std::ranges::reverse(edge);
  for (SeenBand& band : sighting.bands) band.heading = -band.heading;
  return sighting;
}

namespace {

// Returns at most `most` of them, evenly spaced, including the first and the last.
template <class Value>
std::vector<Value> some_of(const std::vector<Value>& values, std::size_t most) {
  const std::size_t count = values.size();
  if (count <= most || most < 2) return values;
  std::vector<Value> some(most);
  for (std::size_t i = 0; i < most; ++i) some[i] = values[i * (count - 1) / (most - 1)];
  return some;
}

}  // namespace

std::vector<CurvePoint> thinned(const std::vector<CurvePoint>& points, std::size_t most) {
  return some_of(points, most);
}

Sighting thinned(Sighting sighting, std::size_t most) {
  sighting.points = some_of(sighting.points, most);
  sighting.borders = some_of(sighting.borders, most);
  for (auto& edge : sighting.edges) edge = some_of(edge, most);
  return sighting;
}

}  // namespace flexura
