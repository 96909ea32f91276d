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

/// Largest number of positions along an arm in one request. Each position becomes a node of the rod.
inline constexpr std::size_t max_statics_places = 1000;

/// Target position of a point of an elastic arm, in the frame of the arm's base.
struct StaticsPoint {
  double at = 0;  ///< Arc length from the base in the undeformed arm, m.
  std::array<double, 3> position = {0, 0, 0};
};

/// Target of an elastic arm in a line of `flexura statics`, in the frame of the arm's base.
struct StaticsTarget {
  std::optional<std::array<double, 3>> tip;  ///< Position of the tip, m.
  std::optional<std::array<double, 3>>
      direction;  ///< Direction of the tip's z axis; its length does not matter.
  std::optional<std::array<double, 4>> rotation;   ///< Rotation of the tip as (w, x, y, z).
  std::optional<std::vector<StaticsPoint>> shape;  ///< Target positions of points along the arm.
  double most_tension = 1000;                      ///< Largest tension of each tendon, N.

  /// Returns the target as a RodTarget. `rod` must have a node at each position of places().
  [[nodiscard]] RodTarget target(const Rod& rod) const;
  /// Returns the positions along the rod of the points of `shape`.
  [[nodiscard]] std::vector<RodPlace> places(const Rod& rod) const;
};

/// Returns the fields of StaticsPoint.
[[nodiscard]] const Table<StaticsPoint>& fields_of(const StaticsPoint* null);
/// Returns the fields of StaticsTarget.
[[nodiscard]] const Table<StaticsTarget>& fields_of(const StaticsTarget* null);

/// Returns the position along a rod whose arc length at rest is `s`, m, from 0 to the rod's length.
[[nodiscard]] RodPlace place_along(const Rod& rod, double s);

/// Reports errors of a target for the rod: no target, two orientations, positions beyond the tip, or no
/// tendons.
void check_statics_target(const Rod& rod, const StaticsTarget& target, Reader& reader);

}  // namespace flexura
