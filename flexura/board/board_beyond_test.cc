#include "flexura/board/board_beyond.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/board/board_target.h"
#include "flexura/camera/intrinsics.h"
#include "tests/support/boards.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr int columns_px = 320, rows_px = 240;

const Intrinsics board_lens = {.fx = 330, .fy = 330, .cx = 159.5, .cy = 119.5};

// The pixels of some columns and rows of a board, starting with the given ones.
std::vector<Eigen::Vector2d> pixels_of(const BoardTarget& board, const Pose& X_CB, const BoardTarget& part,
                                       int first_column, int first_row) {
  const Lens lens(board_lens);
  const auto points = board.points();
  std::vector<Eigen::Vector2d> pixels;
  for (int row = first_row; row < first_row + part.rows; ++row) {
    for (int column = first_column; column < first_column + part.columns; ++column) {
      const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(board.columns) +
                      static_cast<std::size_t>(column);
      pixels.push_back(*lens.project(X_CB * Eigen::Vector3d(points[at].x(), points[at].y(), 0)));
    }
  }
  return pixels;
}

TEST(BoardBeyond, TellsEveryPartOfABoardFromTheWhole) {
  for (const BoardPattern pattern : {BoardPattern::chessboard, BoardPattern::circles}) {
    const BoardTarget board{.pattern = pattern, .columns = 7, .rows = 5};
    for_random_cases(3, [&](TestRandom& random) {
      const Pose X_CB = random_board(random, board, 0.3, 0.6, 0.02);
      const Image<std::uint8_t> picture = board_picture(board, Lens(board_lens), X_CB, columns_px, rows_px);
      EXPECT_FALSE(goes_on(picture, board, pixels_of(board, X_CB, board, 0, 0)));
      for (int columns = 3; columns <= board.columns; ++columns) {
        for (int rows = 3; rows <= board.rows; ++rows) {
          if (columns == board.columns && rows == board.rows) continue;
          const BoardTarget part{.pattern = pattern, .columns = columns, .rows = rows};
          for (const int column : {0, board.columns - columns})
            for (const int row : {0, board.rows - rows})
              EXPECT_TRUE(goes_on(picture, part, pixels_of(board, X_CB, part, column, row)))
                  << columns << "x" << rows << " from " << column << ", " << row;
        }
      }
    });
  }
}

TEST(BoardBeyond, SaysNothingOfWhatThePictureDoesNotShow) {
  const BoardTarget board{.columns = 7, .rows = 5}, part{.columns = 6, .rows = 5};
  TestRandom random(case_seed(0));
  const Pose X_CB = random_board(random, board, 0.3, 0.2, 0.02);
  const auto pixels = pixels_of(board, X_CB, part, 0, 0);
  const Image<std::uint8_t> picture = board_picture(board, Lens(board_lens), X_CB, columns_px, rows_px);
  EXPECT_TRUE(goes_on(picture, part, pixels));
  // The same board, cut off beyond the points.
  double right = 0;
  for (const Eigen::Vector2d& pixel : pixels) right = std::max(right, pixel.x());
  Image<std::uint8_t> cut(static_cast<int>(right) + 3, rows_px);
  for (int v = 0; v < rows_px; ++v)
    for (int u = 0; u < cut.width(); ++u) cut.at(u, v) = picture.at(u, v);
  EXPECT_FALSE(goes_on(cut, part, pixels));
}

}  // namespace
}  // namespace flexura
