#include "flexura/app/statics_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "flexura/base/unit.h"
#include "flexura/math/arrays.h"

namespace flexura {
namespace {

// Wider than the largest arm; keeps sums of squares finite.
constexpr double farthest_target = 1e6;

}  // namespace

const Table<StaticsPoint>& fields_of(const StaticsPoint*) {
  static const auto table =
      Table<StaticsPoint>("statics point", "Target of a point of the arm.")
          .field("at", &StaticsPoint::at,
                 {.meaning = "the point's arc length at rest", .unit = Unit::metre, .range = at_least(0)})
          .field("position", &StaticsPoint::position,
                 {.meaning = "its target position",
                  .unit = Unit::metre,
                  .range = between(-farthest_target, farthest_target)});
  return table;
}

const Table<StaticsTarget>& fields_of(const StaticsTarget*) {
  static const auto table =
      Table<StaticsTarget>("statics target", "Target of the arm.")
          .field("tip", &StaticsTarget::tip,
                 {.meaning = "the tip's position",
                  .unit = Unit::metre,
                  .range = between(-farthest_target, farthest_target)})
          .field("direction", &StaticsTarget::direction,
                 {.meaning = "direction of the tip's z axis",
                  .range = between(-farthest_target, farthest_target)})
          .field("rotation", &StaticsTarget::rotation,
                 {.meaning = "quaternion (w, x, y, z) of the tip's frame", .range = between(-2, 2)})
          .field("shape", &StaticsTarget::shape,
                 {.meaning = "points along the arm", .count = {1, max_statics_places}})
          .field("most_tension", &StaticsTarget::most_tension,
                 {.meaning = "largest tension of each tendon, N", .range = above_up_to(0, 1e9)});
  return table;
}

RodPlace place_along(const Rod& rod, double s) {
  std::size_t section = 0;
  while (section + 1 < rod.sections.size() && s > rod.sections[section].length) {
    s -= rod.sections[section].length;
    ++section;
  }
  return {.section = section, .at = std::clamp(s / rod.sections[section].length, 0.0, 1.0)};
}

std::vector<RodPlace> StaticsTarget::places(const Rod& rod) const {
  std::vector<RodPlace> result;
  for (const StaticsPoint& point : shape.value_or(std::vector<StaticsPoint>{}))
    result.push_back(place_along(rod, point.at));
  return result;
}

RodTarget StaticsTarget::target(const Rod& rod) const {
  RodTarget result;
  if (tip) result.position = vector(*tip);
  if (direction) result.direction = vector(*direction).normalized();
  if (rotation) result.rotation = rotation_of(*rotation);
  const std::vector<RodPlace> along = places(rod);
  for (std::size_t i = 0; i < along.size(); ++i)
    result.places.push_back({along[i], vector((*shape)[i].position)});
  return result;
}

void check_statics_target(const Rod& rod, const StaticsTarget& target, Reader& reader) {
  if (rod.tendons.empty()) reader.problem_at("target", "needs an arm with tendons");
  if (!target.tip && !target.direction && !target.rotation && !target.shape)
    reader.problem_at("target", "is empty: expected tip, direction, rotation or shape");
  if (target.direction && target.rotation)
    reader.problem_at("target", "gives the orientation twice: expected either direction or rotation");
  if (target.direction && !(vector(*target.direction).norm() > 1e-9))
    reader.problem_at("target.direction", "is zero: expected a vector other than zero");
  if (target.rotation) {
    const std::string problem = quaternion_problem(*target.rotation);
    if (!problem.empty()) reader.problem_at("target.rotation", problem);
  }
  const double length = rod.length();
  for (std::size_t i = 0; target.shape && i < target.shape->size(); ++i)
    if (const double at = (*target.shape)[i].at; at > length * (1 + 1e-12))
      reader.problem_at(fmt::format("target.shape[{}].at", i),
                        fmt::format("{} is beyond the tip: expected at most {} m", at, length));
}

}  // namespace flexura
