#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/board/board_target.h"

namespace flexura {

/// A filled rectangle with sides along x and y, m.
struct DrawnRectangle {
  Eigen::Vector2d low, high;
};
/// A filled circle, m.
struct DrawnCircle {
  Eigen::Vector2d center;
  double radius = 0;
};

/// The dark areas of a board, in the board's frame: x to the right, y down, the first point at (0, 0).
struct BoardDrawing {
  std::vector<DrawnRectangle> rectangles;
  std::vector<DrawnCircle> circles;
  Eigen::Vector2d low = {0, 0}, high = {0, 0};  ///< Corners of the rectangle that contains all dark areas, m.
};

/// Returns the dark areas of a board. The radius of circles is 0.3 times the distance between rows
/// (asymmetric circles: 0.42 times). Throws std::invalid_argument if the board needs more markers than the
/// family has, or if the markers are not smaller than `square`.
[[nodiscard]] BoardDrawing draw_board(const BoardTarget& board);

/// A sheet of paper with a board. The board is in the middle.
struct BoardSheet {
  double width = 0, height = 0;  ///< Size of the sheet, m.
  std::string caption;           ///< Text below the board: letters, digits and punctuation of ASCII.
};

/// Returns the drawing as an SVG document, or as a PDF document of one page. Lengths are those of the board
/// if the page is printed at 100 %.
[[nodiscard]] std::string svg_of(const BoardDrawing& drawing, const BoardSheet& sheet);
[[nodiscard]] std::string pdf_of(const BoardDrawing& drawing, const BoardSheet& sheet);

}  // namespace flexura
