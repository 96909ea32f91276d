#include "flexura/board/board_finder.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/board/board_target.h"
#include "flexura/camera/intrinsics.h"
#include "tests/support/boards.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr int width = 320, height = 240;
const Intrinsics lens_numbers = {.fx = 330, .fy = 330, .cx = 159.5, .cy = 119.5};

// Root mean square of the distances from the true points.
double error(const BoardObservation& found, const BoardTarget& board, const Pose& X_CB) {
  const Lens lens(lens_numbers);
  const auto points = board.points();
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = lens.project(X_CB * Eigen::Vector3d(points[i].x(), points[i].y(), 0));
    sum += (found.pixels[i] - *pixel).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

BoardObservation look(const BoardTarget& board, const Pose& X_CB) {
  return find_board(board_picture(board, Lens(lens_numbers), X_CB, width, height), board);
}

// OpenCV would search squares among the grains.
TEST(BoardFinder, DoesNotSearchNoise) {
  BoardTarget board{.columns = 7, .rows = 4};
  // A covered lens, clipped at 0, and brighter pictures.
  for (const auto& [level, deviation] :
       {std::array{0.0, 0.5}, {0.0, 0.7}, {0.0, 1.0}, {2.0, 0.4}, {16.0, 0.5}, {100.0, 30.0}}) {
    TestRandom random(1);
    Image<std::uint8_t> noise(width, height);
    for (std::uint8_t& value : noise.values())
      value = static_cast<std::uint8_t>(
          std::clamp(std::round(level + deviation * normal_number(random)), 0.0, 255.0));
    for (const BoardPattern pattern : {BoardPattern::chessboard, BoardPattern::circles}) {
      board.pattern = pattern;
      EXPECT_EQ(find_board(noise, board).reason, "the picture contains only noise")
          << level << " " << deviation;
    }
  }
}

TEST(BoardFinder, FindsCornersToATwelfthOfAPixelInTheBoardsOrder) {
  const BoardTarget board{.columns = 7, .rows = 4};
  for_random_cases(6, [&](TestRandom& random) {
    const Pose X_CB = random_board(random, board, 0.3, 0.5, 0.05);
    const BoardObservation found = look(board, X_CB);
    ASSERT_TRUE(found.is_found()) << found.reason;
    EXPECT_LT(error(found, board, X_CB), 0.08);
  });
}

TEST(BoardFinder, KnowsTheFirstCornerOfABoardThatIsUpsideDown) {
  const BoardTarget board{.columns = 7, .rows = 4};
  for_random_cases(4, [&](TestRandom& random) {
    Pose X_CB = random_board(random, board, 0.3, 0.4, 0.02);
    const Eigen::Vector3d last(6 * board.square, 3 * board.square, 0);
    X_CB = X_CB * Pose{Eigen::Vector3d(-1, -1, 1).asDiagonal(), last};
    const BoardObservation found = look(board, X_CB);
    ASSERT_TRUE(found.is_found()) << found.reason;
    EXPECT_LT(error(found, board, X_CB), 0.08);
  });
}

TEST(BoardFinder, FindsGridsOfCircles) {
  // Opposite first circles are equivalent if the board is ambiguous.
  const BoardTarget circles{.pattern = BoardPattern::circles, .columns = 7, .rows = 5},
      shifted{.pattern = BoardPattern::asymmetric_circles, .columns = 4, .rows = 7, .square = 0.02};
  for (const BoardTarget& board : {circles, shifted}) {
    TestRandom random(case_seed(0));
    Pose X_CB = random_board(random, board, 0.3, 0.3, 0.02);
    X_CB.position.x() -= board.pattern == BoardPattern::circles ? 0.0 : 0.03;
    const BoardObservation found = look(board, X_CB);
    ASSERT_TRUE(found.is_found()) << found.reason;
    BoardObservation reversed = found;
    std::ranges::reverse(reversed.pixels);
    const double least = std::min(error(found, board, X_CB), error(reversed, board, X_CB));
    EXPECT_LT(board.is_ambiguous() ? least : error(found, board, X_CB), 0.3);
    EXPECT_EQ(look(board, X_CB).pixels, found.pixels);
  }
}

TEST(BoardFinder, SaysWhyThereIsNone) {
  const BoardTarget board;
  for (const auto& picture :
       {Image<std::uint8_t>(64, 48, 1, 90), Image<std::uint8_t>(1, 1), Image<std::uint8_t>(3, 200)})
    for (const BoardPattern pattern :
         {BoardPattern::chessboard, BoardPattern::circles, BoardPattern::asymmetric_circles}) {
      BoardTarget other = board;
      other.pattern = pattern;
      const BoardObservation found = find_board(picture, other);
      EXPECT_FALSE(found.is_found());
      EXPECT_NE(found.reason, "");
    }
}

TEST(BoardFinder, IsNotContentWithAPartOfTheBoard) {
  const BoardTarget board{.columns = 7, .rows = 4}, larger{.columns = 9, .rows = 6};
  TestRandom random(case_seed(0));
  const Pose X_CB = random_board(random, board, 0.3, 0.3, 0.02);
  EXPECT_FALSE(find_board(board_picture(board, Lens(lens_numbers), X_CB, width, height), larger).is_found());
}

TEST(BoardTarget, CannotTellItsFirstPointWhereItLooksTheSameUpsideDown) {
  EXPECT_FALSE((BoardTarget{.columns = 9, .rows = 6}.is_ambiguous()));
  EXPECT_TRUE((BoardTarget{.columns = 8, .rows = 6}.is_ambiguous()));
  EXPECT_TRUE((BoardTarget{.pattern = BoardPattern::circles, .columns = 9, .rows = 6}.is_ambiguous()));
  EXPECT_FALSE(
      (BoardTarget{.pattern = BoardPattern::asymmetric_circles, .columns = 4, .rows = 11}.is_ambiguous()));
}

// The outer squares touch ground as dark as they are.
TEST(BoardFinder, FindsChessboardsWithoutABrightBorder) {
  TestRandom random(9);
  const BoardTarget board{.columns = 7, .rows = 4};
  for (int sample = 0; sample < 4; ++sample) {
    const Pose X_CB = random_board(random, board, 0.35, 0.4, 0.05);
    Image<std::uint8_t> picture = board_picture(board, Lens(lens_numbers), X_CB, width, height);
    const Lens lens(lens_numbers);
    const Pose X_BC = X_CB.inverse();
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const Eigen::Vector3d ray = X_BC.rotation * lens.unproject({u, v})->homogeneous();
        const Eigen::Vector3d at = (X_BC.position - X_BC.position.z() / ray.z() * ray) / board.square;
        const bool is_on = at.x() > -1 && at.y() > -1 && at.x() < board.columns && at.y() < board.rows;
        if (!is_on) picture.at(u, v) = 30;
      }
    }
    const BoardObservation found = find_board(picture, board);
    ASSERT_TRUE(found.is_found()) << sample << found.reason;
    EXPECT_LT(error(found, board, X_CB), 0.1) << sample;
  }
}

TEST(BoardFinder, NamesTheNumbersOfAnotherChessboard) {
  TestRandom random(10);
  const BoardTarget board{.columns = 7, .rows = 4};
  const Pose X_CB = random_board(random, board, 0.35, 0.3, 0.02);
  const auto picture = board_picture(board, Lens(lens_numbers), X_CB, width, height);
  EXPECT_EQ(find_board(picture, {.columns = 8, .rows = 5}).reason,
            "the picture shows a chessboard of 7x4 inner corners, not of 8x5");
}

}  // namespace
}  // namespace flexura
