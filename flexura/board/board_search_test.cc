// The search for a board ends whatever a picture shows: its work is counted.
#include "flexura/board/board_search.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "flexura/board/board_finder.h"
#include "flexura/board/board_target.h"
#include "tests/support/boards.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr int small_width = 520, small_height = 390;
constexpr double most_work = 4e7;  // BoardObservation::work
const Intrinsics small_lens = {.fx = 560, .fy = 560, .cx = 259.5, .cy = 194.5};

// Returns a picture `times` as large, with linear interpolation and normal noise of `sigma`.
Image<std::uint8_t> enlarged(const Image<std::uint8_t>& picture, int times, double sigma) {
  Image<std::uint8_t> large(times * picture.width(), times * picture.height());
  TestRandom random(5);
  // A table is faster than new noise for each pixel.
  std::vector<float> noise(std::size_t{1} << 16U);
  for (float& value : noise) value = static_cast<float>(sigma * normal_number(random));
  std::uint64_t state = 1;
  for (int v = 0; v < large.height(); ++v) {
    for (int u = 0; u < large.width(); ++u) {
      const double x = (u + 0.5) / times - 0.5, y = (v + 0.5) / times - 0.5;
      const int u0 = std::clamp(static_cast<int>(std::floor(x)), 0, picture.width() - 2),
                v0 = std::clamp(static_cast<int>(std::floor(y)), 0, picture.height() - 2);
      const double a = x - u0, b = y - v0;
      const double value = (1 - b) * ((1 - a) * picture.at(u0, v0) + a * picture.at(u0 + 1, v0)) +
                           b * ((1 - a) * picture.at(u0, v0 + 1) + a * picture.at(u0 + 1, v0 + 1));
      state = state * 6364136223846793005U + 1442695040888963407U;
      large.at(u, v) = static_cast<std::uint8_t>(std::clamp(value + noise[state >> 48U], 0.0, 255.0));
    }
  }
  return large;
}

Pose small_pose(const BoardTarget& board) {
  TestRandom random(3);
  return random_board(random, board, 0.45, 0.3, 0.02);
}

Image<std::uint8_t> small_picture(const BoardTarget& board) {
  return board_picture(board, Lens(small_lens), small_pose(board), small_width, small_height);
}

// Returns the largest distance from the true points, px.
double largest_error(const BoardObservation& found, const BoardTarget& board, int times) {
  const Lens lens(small_lens);
  const auto points = board.points();
  double largest = 0, reversed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel =
        *lens.project(small_pose(board) * Eigen::Vector3d(points[i].x(), points[i].y(), 0));
    const Eigen::Vector2d expected = (pixel.array() + 0.5) * times - 0.5;
    largest = std::max(largest, (found.pixels[i] - expected).norm());
    reversed = std::max(reversed, (found.pixels[points.size() - 1 - i] - expected).norm());
  }
  return board.is_ambiguous() ? std::min(largest, reversed) : largest;
}

const BoardTarget chessboard{}, circle_grid{.pattern = BoardPattern::circles, .columns = 8, .rows = 5},
    shifted_circles{.pattern = BoardPattern::asymmetric_circles, .columns = 4, .rows = 7, .square = 0.02};

// The first is of 13 megapixels.
TEST(BoardSearch, FindsBoardsInLargeNoisyPictures) {
  struct Case {
    BoardTarget board;
    int times;
    double sigma, most_error;
  };
  for (const auto& [board, times, sigma, most_error] : {Case{chessboard, 8, 4, 1},
                                                        {chessboard, 1, 12, 0.4},
                                                        {circle_grid, 2, 12, 0.7},
                                                        {shifted_circles, 2, 4, 0.7}}) {
    const BoardObservation found = find_board(enlarged(small_picture(board), times, sigma), board);
    ASSERT_TRUE(found.is_found()) << static_cast<int>(board.pattern) << " " << sigma << found.reason;
    EXPECT_LT(largest_error(found, board, times), most_error);
    EXPECT_LT(found.work, most_work);
  }
}

// OpenCV's search takes minutes for these pictures of chessboards at their full size.
TEST(BoardSearch, EndsForWrongCountsInNoise) {
  struct Case {
    BoardTarget board;
    int times;
  };
  for (const auto& [board, times] : {Case{chessboard, 2}, {chessboard, 4}, {circle_grid, 2}}) {
    BoardTarget wrong = board;
    wrong.columns = 10, wrong.rows = 7;
    const BoardObservation found = find_board(enlarged(small_picture(board), times, 8), wrong);
    EXPECT_FALSE(found.is_found());
    EXPECT_GT(found.work, 0);
    EXPECT_LT(found.work, most_work);
  }
}

// A ground of random spots, as leaves or gravel.
TEST(BoardSearch, EndsInTexture) {
  TestRandom random(2);
  Image<std::uint8_t> texture(small_width, small_height, 1, 200);
  for (int v = 0; v < small_height; ++v)
    for (int u = 0; u < small_width; ++u)
      texture.at(u, v) = static_cast<std::uint8_t>(random.uniform(0, 1) < 0.4 ? 60 : 220);
  const BoardObservation found = find_board(enlarged(texture, 2, 2), chessboard);
  EXPECT_FALSE(found.is_found());
  EXPECT_LT(found.work, most_work);
}

TEST(BoardSearch, ReducedPicturesAreMeansOfFourPixels) {
  cv::Mat picture(401, 403, CV_8U, cv::Scalar(0));
  picture.at<std::uint8_t>(10, 20) = 200;
  const auto pictures = reduced_pictures(picture);
  ASSERT_EQ(pictures.size(), 3U);
  EXPECT_EQ(pictures[1].size(), cv::Size(201, 200));
  EXPECT_EQ(pictures[1].at<std::uint8_t>(5, 10), 50);
  EXPECT_EQ(cv::sum(pictures[1])[0], 50);
}

}  // namespace
}  // namespace flexura
