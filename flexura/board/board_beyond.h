#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// Whether the pattern of the board whose points have these pixels goes on beyond them, by another column or
/// row: they are a part of a larger board then, which OpenCV's search is content with. Of asymmetric circles,
/// of which it hardly takes a part, this is not asked. At least 3 x 3 points.
[[nodiscard]] bool goes_on(const Image<std::uint8_t>& gray, const BoardTarget& board,
                           const std::vector<Eigen::Vector2d>& pixels);

}  // namespace flexura
