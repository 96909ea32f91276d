#include "flexura/vision/tube_seeds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace flexura {
namespace {

using Eigen::Vector2d;

constexpr int seed_count = 7;

// The pixel that contains a position of at least -1.
int nearest(double place) { return static_cast<int>(place + 1.5) - 1; }

// Returns the last distance within the component from `from` along `direction`, at most `limit` px.
double way_out(const Components& components, const Vector2d& from, const Vector2d& direction, double limit) {
  double reach = 0;
  for (; reach < limit; reach += 1) {
    const Vector2d here = from + (reach + 1) * direction;
    if (components.run_at(nearest(here.x()), nearest(here.y())) == nullptr) break;
  }
  return reach + 0.5;
}

}  // namespace

TubeSeed shortest_chord(const Components& components, const Eigen::Vector2d& from, double limit,
                        int directions) {
  TubeSeed best;
  best.width = 1e9;
  for (int i = 0; i < directions; ++i) {
    const double angle = std::numbers::pi * i / directions;
    const Vector2d direction(std::cos(angle), std::sin(angle));
    const double bound = std::min(limit, best.width);
    const double ahead = way_out(components, from, direction, bound);
    if (ahead >= bound) continue;
    const double behind = way_out(components, from, -direction, bound - ahead);
    if (ahead + behind < best.width)
      best = {from + 0.5 * (ahead - behind) * direction, direction, ahead + behind};
  }
  return best;
}

void tube_seeds(const Components& components, const Component& component, std::vector<TubeSeed>& seeds) {
  seeds.clear();
  const double limit = std::hypot(component.right - component.left + 1, component.bottom - component.top + 1);
  // Uses the runs that contain every n-th pixel of the component, and every n-th run. A hair across an arm
  // has many short runs; where an arm overlaps itself there are many pixels.
  const std::int64_t pixels = std::max<std::int64_t>(1, component.area / seed_count);
  const std::uint32_t every = std::max(1U, component.run_count / seed_count);
  const auto own = static_cast<std::uint32_t>(&component - components.list.data());
  std::vector<TubeSeed> by_run;
  const auto add = [&](const Run& run, std::vector<TubeSeed>& to) {
    const TubeSeed seed = shortest_chord(components, {0.5 * (run.first + run.last - 1), run.v}, limit, 8);
    if (seed.width < limit + 2) to.push_back(seed);
  };
  std::uint32_t seen = 0;
  std::int64_t area = 0, next = pixels / 2;
  for (std::size_t i = component.first_run; i < components.runs.size() && seen < component.run_count; ++i) {
    const Run& run = components.runs[i];
    if (run.component != own) continue;
    if (seen++ % every == every / 2) add(run, by_run);
    area += run.last - run.first;
    if (area <= next) continue;
    while (next < area) next += pixels;
    add(run, seeds);
  }
  if (seeds.empty()) seeds = by_run;
  if (seeds.empty()) return;
  std::ranges::sort(seeds, {}, &TubeSeed::width);
  const double median = seeds[seeds.size() / 2].width;
  seeds.insert(seeds.end(), by_run.begin(), by_run.end());
  std::ranges::stable_sort(seeds, {}, [&](const TubeSeed& seed) { return std::abs(seed.width - median); });
}

}  // namespace flexura
