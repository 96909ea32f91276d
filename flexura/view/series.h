#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/view/recording.h"

namespace flexura {

/// Returns the indices, in ascending order, of the values to draw with at most `points` points. These are the
/// first and the last, and for each interval of equal length the minima and maxima of all curves. Borders of
/// gaps (NaN) are added. Returns all indices if there are few, and never fewer than both ends. All curves
/// have the same length.
[[nodiscard]] std::vector<std::size_t> thinned(std::span<const std::vector<double>> curves,
                                               std::size_t points);

/// Quantities of a recording over time: bends, cord angles and archings, stretches, and the tip. Also a
/// servo's errors, which are null while no servo controls the arm.
class SeriesTable {
 public:
  explicit SeriesTable(const Recording& recording);

  /// Returns the quantities of a recording, in display order.
  [[nodiscard]] static std::vector<Quantity> quantities(const Recording& recording);
  /// Returns the answer to /series. Throws ViewRefusal for an unknown name.
  [[nodiscard]] Node answer(const std::vector<std::string>& names, std::size_t points) const;

 private:
  std::vector<double> times_;                          // s
  std::map<std::string, std::vector<double>> curves_;  // By name.
};

}  // namespace flexura
