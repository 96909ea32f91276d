#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// Returns whether the board's pattern continues by another column or row beyond the found points, whose
/// pixels are given. In this case, the points are a part of a larger board; OpenCV's search accepts such
/// parts. This check is not used for asymmetric circles, because OpenCV accepts a part of such a board only
/// in rare cases. Requires at least 3 x 3 points.
[[nodiscard]] bool goes_on(const Image<std::uint8_t>& gray, const BoardTarget& board,
                           const std::vector<Eigen::Vector2d>& pixels);

}  // namespace flexura
