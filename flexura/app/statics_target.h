#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/base/reader.h"
#include "flexura/base/table.h"
#include "flexura/mechanics/inverse_statics.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// Each place asked for along an arm becomes a node of its rod.
inline constexpr std::size_t max_statics_places = 1000;

/// Where a point of an elastic arm shall be, in the frame of its base.
struct StaticsPoint {
  double at = 0;  ///< Arc length at rest from the base, m.
  std::array<double, 3> position = {0, 0, 0};
};

/// Where an elastic arm shall be, as a line of `flexura statics` says it, in the frame of the arm's base.
struct StaticsTarget {
  std::optional<std::array<double, 3>> tip;        ///< Its position, m.
  std::optional<std::array<double, 3>> direction;  ///< Of the tip's z axis, of any length.
  std::optional<std::array<double, 4>> rotation;   ///< (w, x, y, z) of the tip.
  std::optional<std::vector<StaticsPoint>> shape;  ///< Points along the arm.
  double most_tension = 1000;                      ///< Of each tendon, N.

  /// Of a rod that has `places()` as nodes.
  [[nodiscard]] RodTarget target(const Rod& rod) const;
  /// Those of the shape, along the rod.
  [[nodiscard]] std::vector<RodPlace> places(const Rod& rod) const;
};

/// The fields of StaticsPoint.
[[nodiscard]] const Table<StaticsPoint>& fields_of(const StaticsPoint* null);
/// The fields of StaticsTarget.
[[nodiscard]] const Table<StaticsTarget>& fields_of(const StaticsTarget* null);

/// The place of a rod at arc length s at rest, m, from 0 to its length.
[[nodiscard]] RodPlace place_along(const Rod& rod, double s);

/// Reports what does not fit the rod: nothing asked for, two orientations, places beyond the tip, no tendons.
void check_statics_target(const Rod& rod, const StaticsTarget& target, Reader& reader);

}  // namespace flexura
