#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// A board as one picture shows it.
struct BoardSighting {
  std::vector<Eigen::Vector2d>
      pixels;              ///< Of the board's points, in their order; none when it was not found.
  std::string reason;      ///< Why not; "" when it was.
  bool is_larger = false;  ///< Not found, because the pattern goes on: it is a larger board.

  [[nodiscard]] bool is_found() const { return !pixels.empty(); }
};

/// Finds a board of at least 3 x 3 points that is wholly in the picture, by OpenCV's calib3d; corners to a
/// small part of a pixel (W. Foerstner's saddle point, cornerSubPix, in a window that reaches no neighbour).
/// The first point is chosen so that rows and columns turn as on the board and, on a chessboard that can
/// tell, so that the square inward of it is dark. A part of a larger board is none. The same picture gives
/// the same numbers.
[[nodiscard]] BoardSighting find_board(const Image<std::uint8_t>& gray, const BoardTarget& board);

}  // namespace flexura
