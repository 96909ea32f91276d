#include "flexura/board/board_finder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "flexura/board/board_beyond.h"

namespace flexura {
namespace {

using Eigen::Vector2d;
using Corners = std::vector<cv::Point2f>;

// Returns the smallest distance of neighbours in a row or a column, px.
double least_spacing(const Corners& corners, const BoardTarget& board) {
  double least = std::numeric_limits<double>::infinity();
  const auto columns = static_cast<std::size_t>(board.columns);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % columns != 0) least = std::min(least, cv::norm(corners[i] - corners[i - 1]));
    if (i >= columns) least = std::min(least, cv::norm(corners[i] - corners[i - columns]));
  }
  return least;
}

// Half the window in which a corner is refined: ten pixels wide, or a quarter of a square if squares are
// large, without the neighbours' corners.
int half_window(double spacing) {
  constexpr double usual = 5, least = 2;
  const double desired = std::max(usual, spacing / 8);
  return static_cast<int>(std::floor(std::clamp(desired, least, std::max(least, 0.5 * spacing - 1))));
}

// Returns whether neighbouring pixels are uncorrelated, as behind a lens cap. OpenCV would search squares in
// each grain for minutes, in large pictures for hours. A board's squares are several pixels wide.
bool is_noise(const Image<std::uint8_t>& gray) {
  const auto values = gray.values();
  double sum = 0, squares = 0;
  for (const double value : values) sum += value, squares += value * value;
  const auto count = static_cast<double>(values.size());
  const double variance = squares / count - sum * sum / (count * count);
  const auto width = static_cast<std::size_t>(gray.width());
  const auto mean_step = [&](std::size_t apart) {
    double steps = 0;
    for (std::size_t i = apart; i < values.size(); ++i) {
      const double step = double{1} * values[i] - values[i - apart];
      steps += step * step;
    }
    return steps / count;
  };
  // In variances it is 2 for noise of any distribution, 4/3 for squares three pixels wide.
  const double most = 1.6 * variance;
  return mean_step(1) > most && mean_step(width) > most;
}

bool find_corners(const cv::Mat& picture, const BoardTarget& board, Corners& corners) {
  if (!cv::findChessboardCorners(picture, {board.columns, board.rows}, corners,
                                 cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE))
    return false;
  const int half = half_window(least_spacing(corners, board));
  cv::cornerSubPix(picture, corners, {half, half}, {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-6));
  return true;
}

bool find_circles(const cv::Mat& picture, const BoardTarget& board, Corners& corners) {
  // OpenCV's default limits are for pictures of 640 x 480 px.
  cv::SimpleBlobDetector::Params blobs;
  blobs.minArea = 10;
  blobs.maxArea = static_cast<float>(picture.total()) / static_cast<float>(board.columns);
  blobs.minDistBetweenBlobs = 3;
  // The search for the grid uses random numbers: equal ones for every picture.
  cv::setRNGSeed(1);
  const int kind =
      board.pattern == BoardPattern::circles ? cv::CALIB_CB_SYMMETRIC_GRID : cv::CALIB_CB_ASYMMETRIC_GRID;
  return cv::findCirclesGrid(picture, {board.columns, board.rows}, corners, kind,
                             cv::SimpleBlobDetector::create(blobs));
}

// Twice the signed area of the triangle a, b, c: positive for a rotation from u to v.
double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// Mean brightness around the middle of the square whose first corner is `at`.
double brightness(const Image<std::uint8_t>& gray, const std::vector<Vector2d>& pixels, std::size_t at,
                  std::size_t columns) {
  const Vector2d middle =
      0.25 * (pixels[at] + pixels[at + 1] + pixels[at + columns] + pixels[at + columns + 1]);
  const int u = static_cast<int>(std::lround(middle.x())), v = static_cast<int>(std::lround(middle.y()));
  double sum = 0;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du)
      sum += gray.at(std::clamp(u + du, 0, gray.width() - 1), std::clamp(v + dv, 0, gray.height() - 1));
  return sum;
}

// Brings the points into the same order for all cameras, as far as the board determines the order.
void order_as_seen(const Image<std::uint8_t>& gray, const BoardTarget& board, std::vector<Vector2d>& pixels) {
  const auto columns = static_cast<std::size_t>(board.columns), rows = pixels.size() / columns;
  // The order is mirrored, as if the board were seen from behind.
  if (board.pattern != BoardPattern::asymmetric_circles &&
      turn(pixels.front(), pixels[columns - 1], pixels[(rows - 1) * columns]) < 0)
    for (std::size_t row = 0; row < rows; ++row)
      std::reverse(pixels.begin() + static_cast<std::ptrdiff_t>(row * columns),
                   pixels.begin() + static_cast<std::ptrdiff_t>((row + 1) * columns));
  if (board.pattern == BoardPattern::chessboard && !board.is_ambiguous() &&
      brightness(gray, pixels, 0, columns) > brightness(gray, pixels, 1, columns))
    std::ranges::reverse(pixels);
}

}  // namespace

BoardObservation find_board(const Image<std::uint8_t>& gray, const BoardTarget& board) {
  if (is_noise(gray)) return {.pixels = {}, .reason = "the picture contains only noise"};
  // Equal bytes on every machine, whatever its number of processors. (Also, ThreadSanitizer cannot see into
  // the packaged library and reports its locks on this stack as races.)
  cv::setNumThreads(1);
  // OpenCV only reads it.
  const cv::Mat picture(gray.height(), gray.width(), CV_8U, const_cast<std::uint8_t*>(gray.values().data()));
  Corners corners;
  bool is_found = false;
  try {
    is_found = board.pattern == BoardPattern::chessboard ? find_corners(picture, board, corners)
                                                         : find_circles(picture, board, corners);
  } catch (const cv::Exception&) {
    is_found = false;  // For example a picture too small for the search.
  }
  BoardObservation observation;
  const auto is_inside = [&](const cv::Point2f& at) {
    return at.x >= 0 && at.y >= 0 && at.x <= static_cast<float>(gray.width() - 1) &&
           at.y <= static_cast<float>(gray.height() - 1);
  };
  if (!is_found ||
      corners.size() != static_cast<std::size_t>(board.columns) * static_cast<std::size_t>(board.rows) ||
      !std::ranges::all_of(corners, is_inside)) {
    observation.reason = "the picture does not contain a complete board of this size";
    return observation;
  }
  for (const cv::Point2f& corner : corners) observation.pixels.emplace_back(corner.x, corner.y);
  if (goes_on(gray, board, observation.pixels))
    return {.pixels = {},
            .reason = "a part of a larger board: the pattern continues beyond the found points",
            .is_larger = true};
  order_as_seen(gray, board, observation.pixels);
  return observation;
}

}  // namespace flexura
