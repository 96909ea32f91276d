#pragma once

#include <array>
#include <limits>

#include "flexura/base/table.h"
#include "flexura/camera/axis_config.h"

namespace flexura {

/// Units in which an axis is described in a file.
struct AxisUnits {
  Unit position, rate, acceleration;  ///< Units of position, velocity and acceleration.
};

/// Adds the fields common to all axes: largest speed and acceleration, resolution and backlash. S has these
/// members of AxisConfig.
template <class S, class Rate>
void add_axis_fields(Table<S>& table, const AxisUnits& units, Rate S::* max_rate, const char* default_rate) {
  using Number = double S::*;
  table
      .field(
          "max_rate", max_rate,
          {.meaning = "Largest speed.", .unit = units.rate, .range = above(0), .default_text = default_rate})
      .field(
          "max_acceleration", static_cast<Number>(&S::max_acceleration),
          {.meaning = "Largest acceleration.",
           .unit = units.acceleration,
           .range = above(0),
           .default_text = S{}.max_acceleration < std::numeric_limits<double>::infinity() ? "" : "no limit"})
      .field("resolution", static_cast<Number>(&S::resolution),
             {.meaning = "Smallest position increment that can be commanded; 0: continuous.",
              .unit = units.position,
              .range = at_least(0)})
      .field("backlash", static_cast<Number>(&S::backlash),
             {.meaning = "Backlash: motor travel without motion after a reversal.",
              .unit = units.position,
              .range = at_least(0)});
}

/// Reports limits whose first position is the larger one.
void check_limits(const std::array<double, 2>& limits, Reader& reader);

/// Range of the angles of a head's axes, rad.
inline constexpr NumberRange turn_range = {.min = -10, .max = 10};

/// Returns the table of fields of an axis type S, which is an AxisConfig with its own defaults. Limits in a
/// file must be within `range`.
template <class S>
Table<S> axis_table(const char* name, const char* meaning, const AxisUnits& units, const NumberRange& range) {
  Table<S> table(name, meaning);
  table.field("limits", static_cast<std::array<double, 2> S::*>(&S::limits),
              {.meaning = "Smallest and largest position.", .unit = units.position, .range = range});
  add_axis_fields(table, units, static_cast<double S::*>(&S::max_rate),
                  S{}.max_rate < std::numeric_limits<double>::infinity() ? "" : "no limit");
  table.check([](const S& axis, Reader& reader) { check_limits(axis.limits, reader); });
  return table;
}

}  // namespace flexura
