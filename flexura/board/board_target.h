#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace flexura {

/// Pattern of a calibration board.
enum class BoardPattern { chessboard, circles, asymmetric_circles };
const std::vector<std::string>& names_of(const BoardPattern*);

/// A flat calibration board. Its points are the inner corners of a chessboard, or the centres of dark circles
/// on a bright background.
struct BoardTarget {
  BoardPattern pattern = BoardPattern::chessboard;
  int columns = 9, rows = 6;  ///< Numbers of columns and rows of points. For asymmetric circles, `columns` is
                              ///< the number of points in one row.
  /// Distance between neighbouring rows, and between neighbouring columns, m. Circles in a row of asymmetric
  /// circles are 2 `square` apart, and every second row is shifted by `square`.
  double square = 0.025;

  /// Returns the points in the board's plane, m, row by row. The first point is (0, 0).
  [[nodiscard]] std::vector<Eigen::Vector2d> points() const;
  /// Returns the orders of the points in which the board looks the same, its own order first. In the k-th
  /// order, point i is point k[i] of the own order. An ambiguous board has two orders, or four if it has as
  /// many columns as rows; other boards have one.
  [[nodiscard]] std::vector<std::vector<std::size_t>> equal_orders() const;
  /// Returns whether a picture does not determine which of two opposite corners is the first point. In this
  /// case, two cameras may choose different corners; their common views then decide (intrinsics_fit.h).
  [[nodiscard]] bool is_ambiguous() const;
};

}  // namespace flexura
