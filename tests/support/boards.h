#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/board/board_bundle.h"
#include "flexura/board/board_target.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Image sizes of one camera and of two, pixels.
inline const std::vector<std::array<int, 2>> one_size = {{640, 480}}, two_sizes = {{640, 480}, {640, 480}};

/// Returns a board pose in front of a camera that looks along z. The board is `distance` m away, tilted by up
/// to `tilt` rad and rotated by up to a quarter turn. Its centre is up to `aside` times the distance off the
/// axis.
inline Pose random_board(TestRandom& random, const BoardTarget& board, double distance, double tilt = 0.6,
                         double aside = 0.2) {
  const double direction = random.uniform(0, 2 * std::numbers::pi), angle = random.uniform(0.3, 1) * tilt;
  Pose X_CB;
  X_CB.rotation = so3_exp({angle * std::cos(direction), angle * std::sin(direction), 0}) *
                  so3_exp({0, 0, random.uniform(-0.8, 0.8)});
  const Eigen::Vector3d middle(0.5 * board.square * (board.columns - 1),
                               0.5 * board.square * (board.rows - 1), 0);
  X_CB.position =
      Eigen::Vector3d(random.uniform(-aside, aside), random.uniform(-aside, aside), 1) * distance -
      X_CB.rotation * middle;
  return X_CB;
}

/// Returns what the bundle's cameras see of the board, with normal noise of `sigma` px.
inline std::vector<BoardView> seen_boards(const BoardBundle& truth,
                                          const std::vector<Eigen::Vector2d>& points, double sigma,
                                          TestRandom& random) {
  std::vector<BoardView> views;
  for (const Pose& X_1B : truth.boards) {
    BoardView& view = views.emplace_back();
    for (std::size_t camera = 0; camera < truth.lenses.size(); ++camera) {
      const Lens lens(truth.lenses[camera]);
      auto& pixels = view.pixels.emplace_back();
      for (const Eigen::Vector2d& point : points) {
        const Eigen::Vector3d p_CP =
            truth.cameras[camera].inverse() * (X_1B * Eigen::Vector3d(point.x(), point.y(), 0));
        pixels.push_back(lens.project(p_CP).value() +
                         sigma * Eigen::Vector2d(normal_number(random), normal_number(random)));
      }
    }
  }
  return views;
}

/// Returns whether a marker with its upper left corner at (0, 0) is dark at a point, given in sides of the
/// marker.
inline bool is_dark_marker(FiducialFamily family, int id, const Eigen::Vector2d& at) {
  const int cells = side_of(family) + 2;
  const int column = static_cast<int>(std::floor(at.x() * cells)),
            row = static_cast<int>(std::floor(at.y() * cells));
  return row >= 0 && column >= 0 && row < cells && column < cells && is_black_cell(family, id, row, column);
}

/// The same for a board with markers. `layout`: index in fiducial_layouts().
inline bool is_dark_with_markers(const BoardTarget& board, const Eigen::Vector2d& at, int layout) {
  const double side = board.marker / board.square;
  const int column = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()));
  const Eigen::Vector2d inside = at - Eigen::Vector2d(column, row);
  if (board.pattern == BoardPattern::apriltags) {
    if (column < 0 || row < 0 || column >= board.columns || row >= board.rows) return false;
    const int counted = layout == 0 ? row : board.rows - 1 - row;
    return is_dark_marker(board.family, counted * board.columns + column, inside / side);
  }
  if (column < -1 || row < -1 || column >= board.columns || row >= board.rows) return false;
  if ((column + row) % 2 == 0 ? layout == 0 : layout == 1) return true;
  // Squares with markers in the rows above, and before this one.
  int id = 0;
  for (int r = -1; r <= row; ++r)
    for (int c = -1; c < (r < row ? board.columns : column); ++c)
      id += (r + c) % 2 == 0 ? layout : 1 - layout;
  return is_dark_marker(board.family, id, (inside - 0.5 * (1 - side) * Eigen::Vector2d::Ones()) / side);
}

/// Returns whether the board is dark at a point of its plane, given in units of `square`.
inline bool is_dark(const BoardTarget& board, const Eigen::Vector2d& at, int layout = 0) {
  if (board.has_markers()) return is_dark_with_markers(board, at, layout);
  if (board.pattern == BoardPattern::chessboard) {
    const bool is_on = at.x() > -1 && at.y() > -1 && at.x() < board.columns && at.y() < board.rows;
    const auto cell = static_cast<int>(std::floor(at.x()) + std::floor(at.y()));
    return is_on && cell % 2 == 0;
  }
  constexpr double radius = 0.3;
  const double row = std::clamp(std::round(at.y()), 0.0, board.rows - 1.0);
  const bool is_shifted = board.pattern == BoardPattern::asymmetric_circles;
  const double step = is_shifted ? 2 : 1, shift = is_shifted && static_cast<int>(row) % 2 == 1 ? 1 : 0;
  const double column = std::clamp(std::round((at.x() - shift) / step), 0.0, board.columns - 1.0);
  return (at - Eigen::Vector2d(step * column + shift, row)).norm() < radius * (is_shifted ? 1.4 : 1);
}

/// Renders the board on a bright background, with sixteen samples per pixel.
inline Image<std::uint8_t> board_picture(const BoardTarget& board, const Lens& lens, const Pose& X_CB,
                                         int width, int height, int layout = 0) {
  Image<std::uint8_t> picture(width, height);
  const Pose X_BC = X_CB.inverse();
  constexpr int side = 4;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      int dark = 0;
      for (int sample = 0; sample < side * side; ++sample) {
        // No two samples share a row or a column, so that edges along rows and columns are exact, too.
        const double across = sample % side, down = sample / side;
        const Eigen::Vector2d pixel(u + (across + (down + 0.5) / side) / side - 0.5,
                                    v + (down + (across + 0.5) / side) / side - 0.5);
        const auto direction = lens.unproject(pixel);
        if (!direction) continue;
        const Eigen::Vector3d ray = X_BC.rotation * direction->homogeneous();
        const Eigen::Vector3d at = X_BC.position - X_BC.position.z() / ray.z() * ray;
        dark += is_dark(board, at.head<2>() / board.square, layout) ? 1 : 0;
      }
      picture.at(u, v) = static_cast<std::uint8_t>(225 - 195 * dark / (side * side));
    }
  }
  return picture;
}

}  // namespace flexura
