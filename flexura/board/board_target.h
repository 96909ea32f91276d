#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/board/fiducial.h"

namespace flexura {

/// Pattern of a calibration board.
enum class BoardPattern { chessboard, circles, asymmetric_circles, charuco, apriltags };
const std::vector<std::string>& names_of(const BoardPattern*);

/// A flat calibration board. The points of a board are the inner corners of a chessboard (`charuco`: with a
/// marker in each white square), the centres of dark circles on a bright background, or the corners of
/// markers (`apriltags`).
struct BoardTarget {
  BoardPattern pattern = BoardPattern::chessboard;
  /// Numbers of columns and rows of points. For asymmetric circles, `columns` is the number of points in one
  /// row. For `apriltags`, these are the numbers of markers.
  int columns = 9, rows = 6;
  /// Distance between neighbouring rows, and between neighbouring columns, m. Circles in a row of asymmetric
  /// circles are 2 `square` apart, and every second row is shifted by `square`. For `apriltags`, it is the
  /// distance between corresponding corners of neighbouring markers.
  double square = 0.025;
  double marker = 0;  ///< Side of the markers with their black border, m; of boards with markers.
  FiducialFamily family = FiducialFamily::aruco_4x4;  ///< Family of the markers; of boards with markers.

  /// Returns whether the board has markers. A picture may then show a part of the board.
  [[nodiscard]] bool has_markers() const {
    return pattern == BoardPattern::charuco || pattern == BoardPattern::apriltags;
  }
  /// Returns the number of markers.
  [[nodiscard]] int markers() const;

  /// Returns the points in the board's plane, m, row by row. The first point is (0, 0). For `apriltags`, each
  /// marker has four points: its corners, clockwise from the upper left one.
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
