#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/view/recording.h"

namespace flexura {

/// Which of so many values to draw when there shall be no more than `points`: the first and the last, and in
/// stretches of equal length between the places where any of the curves is least and greatest. Beside these
/// the borders of gaps (NaN). Ascending. All of them where they are few; never fewer than the ends. The
/// curves are of one length.
[[nodiscard]] std::vector<std::size_t> thinned(std::span<const std::vector<double>> curves,
                                               std::size_t points);

/// What a recording's arm does over time: bends, cord angles and archings, stretches, the tip; and a servo's
/// errors, which are null where none steers the arm.
class SeriesTable {
 public:
  explicit SeriesTable(const Recording& recording);

  /// The quantities of a recording, in the order shown.
  [[nodiscard]] static std::vector<Quantity> quantities(const Recording& recording);
  /// The answer to /series; a ViewRefusal for a name that there is not.
  [[nodiscard]] Node answer(const std::vector<std::string>& names, std::size_t points) const;

 private:
  std::vector<double> times_;                          // s
  std::map<std::string, std::vector<double>> curves_;  // by name
};

}  // namespace flexura
