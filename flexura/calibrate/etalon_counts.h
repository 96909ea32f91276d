#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/image.h"

namespace flexura {

/// What the paper counts in a picture of the calibration cylinder (section 3.4), as printed: whole pixels on
/// either side of a threshold.
struct EtalonCounts {
  std::string reason;        ///< Why there is nothing to count; "" when there is.
  int left = 0, right = 0;   ///< White pixels beside the line with most black ones: p_st, p_dr.
  int above = 0, below = 0;  ///< White pixels of the column with most black ones: p_sus, p_jos.
  int first = 0, last = 0;   ///< Black pixels of the first and the last line that have any: p_sup, p_inf.
  std::int64_t white = 0;    ///< White pixels in all: p_zoom.
  std::vector<double> axes;  ///< Columns of the red axes, left to right.
  double middle = 0;         ///< Column half-way between the whites to the left and right.
};

/// Of a picture in red, green and blue.
[[nodiscard]] EtalonCounts count_etalon(const Image<std::uint8_t>& picture);

}  // namespace flexura
