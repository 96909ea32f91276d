#include "flexura/board/fiducial_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/base/names.h"
#include "flexura/board/board_finder.h"
#include "flexura/board/fiducial.h"
#include "tests/support/boards.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr int picture_width = 480, picture_height = 360;
const Intrinsics wide_lens = {.fx = 500, .fy = 500, .cx = 239.5, .cy = 179.5};
const BoardTarget chess_markers{
    .pattern = BoardPattern::charuco, .columns = 7, .rows = 4, .square = 0.03, .marker = 0.022};
const BoardTarget tags{.pattern = BoardPattern::apriltags,
                       .columns = 5,
                       .rows = 3,
                       .square = 0.05,
                       .marker = 0.04,
                       .family = FiducialFamily::apriltag_36h11};

constexpr FiducialFamily families[] = {FiducialFamily::aruco_4x4, FiducialFamily::aruco_5x5,
                                       FiducialFamily::aruco_6x6, FiducialFamily::apriltag_36h11};

// Points that are in the picture: how many, how many were found, and the errors of these.
struct Comparison {
  int inside = 0, found = 0, outside_found = 0;
  double rms = 0, largest = 0;
};

Comparison compared(const BoardObservation& seen, const BoardTarget& board, const Pose& X_CB) {
  const Lens lens(wide_lens);
  const auto points = board.points();
  Comparison result;
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel =
        lens.project(X_CB * Eigen::Vector3d(points[i].x(), points[i].y(), 0)).value();
    constexpr double border = 12;  // px: nearer ones need not be found.
    const bool is_inside = pixel.x() > border && pixel.y() > border &&
                           pixel.x() < picture_width - 1 - border && pixel.y() < picture_height - 1 - border;
    const bool is_found = seen.is_found() && is_seen(seen.pixels[i]);
    result.inside += is_inside ? 1 : 0;
    result.found += is_inside && is_found ? 1 : 0;
    result.outside_found += !is_inside && is_found ? 1 : 0;
    if (!is_found) continue;
    const double error = (seen.pixels[i] - pixel).norm();
    sum += error * error, result.largest = std::max(result.largest, error);
  }
  result.rms = std::sqrt(sum / std::max(1, result.found + result.outside_found));
  return result;
}

BoardObservation look_with_markers(const BoardTarget& board, const Pose& X_CB, int layout = 0) {
  return find_board(board_picture(board, Lens(wide_lens), X_CB, picture_width, picture_height, layout),
                    board);
}

TEST(Fiducial, EachMarkerIsRecognised) {
  for (const FiducialFamily family : families) {
    for (int one = 0; one < count_of(family); ++one) {
      const auto match = match_fiducial(family, code_of(family, one), count_of(family));
      ASSERT_TRUE(match);
      EXPECT_EQ(match->id, one);
      EXPECT_EQ(match->turns, 0);
      EXPECT_EQ(match->errors, 0);
    }
  }
}

// Checked cell by cell, without the functions that read codes.
TEST(Fiducial, RecognisesTurnedMarkersWithWrongCells) {
  TestRandom random(1);
  for (const FiducialFamily family : families) {
    const int side = side_of(family);
    for (int sample = 0; sample < 50; ++sample) {
      const int id = random.integer(0, count_of(family) - 1);
      std::vector<std::vector<bool>> white(static_cast<std::size_t>(side),
                                           std::vector<bool>(static_cast<std::size_t>(side)));
      for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
          white[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
              !is_black_cell(family, id, row + 1, column + 1);
      const int turns = random.integer(0, 3);
      for (int k = 0; k < turns; ++k) {  // Counterclockwise.
        auto next = white;
        for (std::size_t row = 0; row < white.size(); ++row)
          for (std::size_t column = 0; column < white.size(); ++column)
            next[white.size() - 1 - column][row] = white[row][column];
        white = next;
      }
      for (int k = 0; k < most_errors_of(family); ++k) {
        auto&& cell = white[static_cast<std::size_t>(random.integer(0, side - 1))]
                           [static_cast<std::size_t>(random.integer(0, side - 1))];
        cell = !cell;
      }
      std::uint64_t cells = 0;
      for (const auto& row : white)
        for (const bool is_white : row) cells = cells << 1U | (is_white ? 1U : 0U);
      const auto match = match_fiducial(family, cells, count_of(family));
      ASSERT_TRUE(match) << name_of(family) << " " << id;
      EXPECT_EQ(match->id, id) << name_of(family);
      EXPECT_EQ(match->turns, turns) << name_of(family) << " " << id;
      EXPECT_LE(match->errors, most_errors_of(family));
    }
  }
}

TEST(FiducialBoard, IsFoundWhole) {
  TestRandom random(2);
  for (const BoardTarget& board : {chess_markers, tags}) {
    for (int sample = 0; sample < 4; ++sample) {
      const Pose X_CB =
          random_board(random, board, board.pattern == BoardPattern::charuco ? 0.42 : 0.6, 0.5, 0.02);
      const BoardObservation seen = look_with_markers(board, X_CB);
      const Comparison comparison = compared(seen, board, X_CB);
      EXPECT_EQ(comparison.found, comparison.inside)
          << name_of(board.pattern) << " " << sample << ": " << seen.reason;
      EXPECT_GT(comparison.found, 20);
      EXPECT_LT(comparison.rms, 0.15) << name_of(board.pattern) << " " << sample;
      EXPECT_LT(comparison.largest, 0.5) << name_of(board.pattern) << " " << sample;
    }
  }
}

TEST(FiducialBoard, PartsAreFound) {
  TestRandom random(3);
  for (const BoardTarget& board : {chess_markers, tags}) {
    for (int sample = 0; sample < 4; ++sample) {
      Pose X_CB = random_board(random, board, 0.3, 0.4, 0);
      X_CB.position.x() += sample % 2 == 0 ? 0.1 : -0.1;
      const BoardObservation seen = look_with_markers(board, X_CB);
      const Comparison comparison = compared(seen, board, X_CB);
      EXPECT_LT(comparison.inside, static_cast<int>(board.points().size()));
      // A marker beside the picture's border may be cut, and with it the corners beside it.
      EXPECT_GE(comparison.found, comparison.inside / 2)
          << name_of(board.pattern) << " " << sample << seen.reason;
      EXPECT_LT(comparison.rms, 0.15) << name_of(board.pattern) << " " << sample;
    }
  }
}

TEST(FiducialBoard, HiddenPointsAreMissing) {
  TestRandom random(4);
  for (const BoardTarget& board : {chess_markers, tags}) {
    const Pose X_CB = random_board(random, board, 0.42, 0.3, 0);
    Image<std::uint8_t> picture = board_picture(board, Lens(wide_lens), X_CB, picture_width, picture_height);
    // A hand in front of the left half.
    for (int v = 0; v < picture_height; ++v)
      for (int u = 0; u < picture_width / 2; ++u) picture.at(u, v) = 120;
    const BoardObservation seen = find_board(picture, board);
    ASSERT_TRUE(seen.is_found()) << seen.reason;
    int found = 0;
    for (const Eigen::Vector2d& pixel : seen.pixels) {
      if (!is_seen(pixel)) continue;
      ++found;
      // The lines through the visible parts of a marker determine corners that are just hidden.
      EXPECT_GT(pixel.x(), picture_width / 2 - 5);
    }
    EXPECT_GT(found, 6);
    EXPECT_LT(compared(seen, board, X_CB).rms, 0.15) << name_of(board.pattern);
  }
}

// ChArUco boards of OpenCV before 4.7 with an even number of rows begin with a white square; some grids of
// AprilTags count from below.
TEST(FiducialBoard, BothLayoutsAreFound) {
  TestRandom random(5);
  for (BoardTarget board : {chess_markers, tags}) {
    board.rows = 3;  // Four rows of squares.
    for (const int layout : {0, 1}) {
      const Pose X_CB = random_board(random, board, 0.5, 0.4, 0.02);
      const BoardObservation seen = look_with_markers(board, X_CB, layout);
      const Comparison comparison = compared(seen, board, X_CB);
      EXPECT_EQ(comparison.found, comparison.inside)
          << name_of(board.pattern) << " " << layout << seen.reason;
      EXPECT_LT(comparison.rms, 0.1) << name_of(board.pattern) << " " << layout;
    }
  }
}

TEST(FiducialBoard, ReasonsNameWhatIsWrong) {
  TestRandom random(6);
  const Pose X_CB = random_board(random, tags, 0.42, 0.3, 0);
  const auto picture = board_picture(tags, Lens(wide_lens), X_CB, picture_width, picture_height);
  BoardTarget other = tags;
  other.family = FiducialFamily::aruco_6x6;
  EXPECT_THAT(find_board(picture, other).reason, HasSubstr("no marker of the family 6x6"));
  // Numbers of one board in the order of another.
  other = tags;
  other.columns = 3, other.rows = 5;
  EXPECT_THAT(find_board(picture, other).reason, HasSubstr("do not fit a board of 3x5"));
  EXPECT_FALSE(find_board(picture, other).is_found());
  EXPECT_THAT(find_board(board_picture({.columns = 7, .rows = 4}, Lens(wide_lens), X_CB, picture_width,
                                       picture_height),
                         chess_markers)
                  .reason,
              HasSubstr("no marker"));
}

}  // namespace
}  // namespace flexura
