#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// Result of the search for a board in one picture.
struct BoardObservation {
  /// Pixels (u, v) of the board's points, in the board's order, px; empty if the board was not found. Points
  /// of a board with markers that the picture does not show are NaN.
  std::vector<Eigen::Vector2d> pixels;
  std::string reason;  ///< Reason why the board was not found; otherwise "".
  /// Whether the found points were rejected because the pattern continues, as on a larger board.
  bool is_larger = false;
  /// Counted work of the search: pixels, plus 40 for each pair of spots that may be squares or circles. The
  /// work is at most 4e7 for boards of up to 100 points, whatever the picture shows.
  double work = 0;

  [[nodiscard]] bool is_found() const { return !pixels.empty(); }
};

/// Finds a board. A board with markers may be partly in the picture (fiducial_board.h). Other boards have at
/// least 3 x 3 points and must be entirely in the picture; they are found with OpenCV's calib3d. Pictures of
/// more than 1.4 megapixels are searched at a reduced size, and at twice this size up to 5.6 megapixels;
/// found points are refined in the picture itself. Corners are refined to subpixel accuracy (W. Foerstner's
/// saddle point, cornerSubPix) in a window without neighbouring corners. The first point is chosen so that
/// rows and columns have the same orientation as on the board. On an unambiguous chessboard, the square
/// inward of the first point is dark. The function does not accept a part of a larger board. Equal pictures
/// give equal results.
[[nodiscard]] BoardObservation find_board(const Image<std::uint8_t>& gray, const BoardTarget& board);

}  // namespace flexura
