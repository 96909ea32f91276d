#include "flexura/estimate/observation.h"

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

bool are_enough(std::span<const Observation> observations) {
  constexpr std::size_t fewest = 4;
  const auto has_axis = [](const Observation& seen) { return seen.points.size() >= fewest; };
  const auto is_seen = [&](const Observation& seen) {
    return has_axis(seen) || seen.borders.size() >= 2 * fewest;
  };
  return std::ranges::any_of(observations, has_axis) && std::ranges::all_of(observations, is_seen);
}

Observation reversed(Observation observation) {
  std::ranges::reverse(observation.points);
  std::swap(observation.ends[0], observation.ends[1]);
  std::swap(observation.edges[0], observation.edges[1]);
  for (auto& edge : observation.edges) std::ranges::reverse(edge);
  for (SeenBand& band : observation.bands) band.heading = -band.heading;
  return observation;
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

Observation thinned(Observation observation, std::size_t most) {
  observation.points = some_of(observation.points, most);
  observation.borders = some_of(observation.borders, most);
  for (auto& edge : observation.edges) edge = some_of(edge, most);
  return observation;
}

}  // namespace flexura
