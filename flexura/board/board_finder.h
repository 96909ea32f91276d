#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// A board in one picture.
struct BoardObservation {
  /// Image points of the board, in its order; empty if it was not found.
  std::vector<Eigen::Vector2d> pixels;
  std::string reason;      ///< Why it was not found; "" if it was.
  bool is_larger = false;  ///< Not found because the pattern continues: it is a larger board.

  [[nodiscard]] bool is_found() const { return !pixels.empty(); }
};

/// Finds a board of at least 3 x 3 points that is entirely in the picture, by OpenCV's calib3d. Corners are
/// subpixel (W. Foerstner's saddle point, cornerSubPix, in a window without neighbouring corners). The first
/// point is chosen so that rows and columns turn as on the board. On an unambiguous chessboard the square
/// inward of it is also dark. A part of a larger board is not accepted. Equal pictures give equal results.
[[nodiscard]] BoardObservation find_board(const Image<std::uint8_t>& gray, const BoardTarget& board);

}  // namespace flexura
