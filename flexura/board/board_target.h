#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace flexura {

/// What is printed on a calibration board.
enum class BoardPattern { chessboard, circles, asymmetric_circles };
const std::vector<std::string>& names_of(const BoardPattern*);

/// A flat calibration board. Its points, which pictures are searched for, are the inner corners of a
/// chessboard or the centres of dark circles on bright ground.
struct BoardTarget {
  BoardPattern pattern = BoardPattern::chessboard;
  int columns = 9, rows = 6;  ///< Of points; of asymmetric circles, those in one row.
  double square = 0.025;  ///< m from row to row; from column to column too, but for asymmetric circles, where
                          ///< it is twice that and every second row is shifted by half of it.

  /// The points in the board's plane, m, row after row from the first corner; (0, 0) is the first.
  [[nodiscard]] std::vector<Eigen::Vector2d> points() const;
  /// Whether a picture cannot tell which of two opposite corners is the first: two cameras may then disagree.
  [[nodiscard]] bool is_ambiguous() const;
};

}  // namespace flexura
