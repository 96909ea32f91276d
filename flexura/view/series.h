#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/view/recording.h"

namespace flexura {

/// Selects at most `points` values to draw, and returns their indices in ascending order. The selected values
/// are the first and the last value, and the minima and maxima of all curves in intervals of equal length.
/// Values at the borders of gaps (NaN) are selected in addition. If there are few values, returns all
/// indices. All curves must have the same length.
[[nodiscard]] std::vector<std::size_t> thinned(std::span<const std::vector<double>> curves,
                                               std::size_t points);

/// Quantities of a recording over time: bends, cord angles and archings, stretches, and the tip. A
/// SeriesTable also has the errors of servos, which are null while no servo controls the arm.
class SeriesTable {
 public:
  explicit SeriesTable(const Recording& recording);

  /// Returns the quantities of a recording, in display order.
  [[nodiscard]] static std::vector<Quantity> quantities(const Recording& recording);
  /// Returns the answer to /series. Throws ViewRefusal for an unknown name.
  [[nodiscard]] Node answer(const std::vector<std::string>& names, std::size_t points) const;

 private:
  std::vector<double> times_;                          // Times, s.
  std::map<std::string, std::vector<double>> curves_;  // Values of each quantity, by its name.
};

}  // namespace flexura
