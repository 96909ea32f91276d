#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace flexura {

/// Pattern of a calibration board.
enum class BoardPattern { chessboard, circles, asymmetric_circles };
const std::vector<std::string>& names_of(const BoardPattern*);

/// A flat calibration board. Its points, which are searched in pictures, are the inner corners of a
/// chessboard or the centres of dark circles on a bright background.
struct BoardTarget {
  BoardPattern pattern = BoardPattern::chessboard;
  int columns = 9, rows = 6;  ///< Numbers of columns and rows of points; for asymmetric circles, `columns`
                              ///< are those in one row.
  double square = 0.025;  ///< Distance of rows, and of columns, m. Columns of asymmetric circles are twice
                          ///< that apart, and every second row is shifted by half of it.

  /// Returns the points in the board's plane, m, row after row from the first corner; (0, 0) is the first.
  [[nodiscard]] std::vector<Eigen::Vector2d> points() const;
  /// Returns whether two opposite corners are indistinguishable as the first in a picture: two cameras may
  /// then disagree.
  [[nodiscard]] bool is_ambiguous() const;
};

}  // namespace flexura
