#pragma once

#include <array>
#include <optional>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/base/unit.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/statics.h"

namespace flexura {

/// Loads on an elastic arm in a line of `flexura statics` or `flexura linearise`, in the frame of the arm's
/// base.
struct RodRequest {
  std::optional<std::vector<double>> tensions;       ///< Tensions of the tendons at the base, N.
  std::optional<std::vector<double>> displacements;  ///< Lengths by which the tendons are pulled in, m.
  std::array<double, 3> tip_force = {0, 0, 0};       ///< Force at the tip, N.
  std::array<double, 3> tip_moment = {0, 0, 0};      ///< Moment at the tip, N m.
  std::optional<std::array<double, 3>> gravity;  ///< Gravity, m/s^2; default: the gravity in the arm's file.

  /// Returns the tendons' prescribed tensions or displacements.
  [[nodiscard]] TendonInput tendons() const;
  /// Returns the loads `of_arm` with this request's gravity, tip force and tip moment.
  [[nodiscard]] RodLoads loads(const Rod& rod, RodLoads of_arm) const;
};

/// Adds the fields of RodRequest to the table of a derived request.
template <typename Request>
Table<Request>& add_rod_fields(Table<Request>& table) {
  constexpr NumberRange load_range = {.min = -1e9, .max = 1e9};
  return table
      .field("tensions", &Request::tensions,
             {.meaning = "tendons' tensions at the base, N", .range = between(0, 1e9)})
      .field("displacements", &Request::displacements,
             {.meaning = "lengths by which the tendons are pulled in",
              .unit = Unit::metre,
              .range = between(-1e6, 1e6)})
      .field("tip_force", &Request::tip_force, {.meaning = "force at the tip, N", .range = load_range})
      .field("tip_moment", &Request::tip_moment, {.meaning = "moment at the tip, N m", .range = load_range})
      .field("gravity", &Request::gravity,
             {.meaning = "gravity, instead of the file's",
              .unit = Unit::metre_per_second_squared,
              .range = between(-1e6, 1e6)});
}

/// Reports an error if the number of tensions or displacements is not the number of tendons, or if both
/// tensions and displacements are given.
void check_rod_request(const Rod& rod, const RodRequest& request, Reader& reader);

}  // namespace flexura
