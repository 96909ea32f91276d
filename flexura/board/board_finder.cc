#include "flexura/board/board_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "flexura/board/board_beyond.h"
#include "flexura/board/board_search.h"
#include "flexura/board/fiducial_board.h"

namespace flexura {
namespace {

using Eigen::Vector2d;
using Corners = std::vector<cv::Point2f>;

// Returns whether neighbouring pixels are uncorrelated, as behind a lens cap. A board's squares are several
// pixels wide.
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

// Refines points from a reduced picture up to the picture itself.
bool refine_up(const std::vector<cv::Mat>& pictures, std::size_t level, const BoardSearch& search,
               const BoardTarget& board, Corners& corners) {
  if (board.pattern == BoardPattern::chessboard && !search.refine(pictures[level], corners)) return false;
  while (level > 0) {
    --level;
    for (cv::Point2f& corner : corners) corner = 2 * corner + cv::Point2f(0.5F, 0.5F);
    // Circles are measured once, in the picture itself.
    const bool is_due = board.pattern == BoardPattern::chessboard || level == 0;
    if (is_due && !search.refine(pictures[level], corners)) return false;
  }
  return true;
}

// Searches reduced pictures first: there, noise is smaller and the work is bounded.
bool search_levels(const cv::Mat& picture, const BoardTarget& board, Corners& corners,
                   BoardObservation& observation) {
  const std::vector<cv::Mat> pictures = reduced_pictures(picture);
  std::size_t first = 0;
  while (first + 1 < pictures.size() && static_cast<double>(pictures[first].total()) > first_search_pixels)
    ++first;
  std::vector<std::size_t> levels = {first};
  if (first + 1 < pictures.size()) levels.push_back(first + 1);
  if (first > 0 && static_cast<double>(pictures[first - 1].total()) <= last_search_pixels)
    levels.push_back(first - 1);
  BoardSearch search(board);
  bool is_found = false;
  for (std::size_t i = 0; i < levels.size() && !is_found; ++i)
    is_found =
        search.find(pictures[levels[i]], corners) && refine_up(pictures, levels[i], search, board, corners);
  observation.work = search.work();
  if (is_found) return true;
  observation.reason = "the picture does not contain a complete board of this size";
  // Of the reduced picture searched first.
  Corners unused;
  const bool is_chessboard = board.pattern == BoardPattern::chessboard;
  if (!is_chessboard && search.find(pictures[first], unused)) return false;
  cv::Size other = is_chessboard ? BoardSearch::other_chessboard(pictures[first]) : search.other_grid();
  // Columns and rows of a chessboard are found in any order.
  if (is_chessboard && (other.width < other.height) != (board.columns < board.rows))
    std::swap(other.width, other.height);
  const bool is_same =
      (other == cv::Size(board.columns, board.rows)) || (other == cv::Size(board.rows, board.columns));
  if (other.width > 0 && !is_same)
    observation.reason = fmt::format("the picture shows a {} of {}x{} {}, not of {}x{}",
                                     is_chessboard ? "chessboard" : "grid", other.width, other.height,
                                     is_chessboard ? "inner corners" : "circles", board.columns, board.rows);
  return false;
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
  if (board.has_markers()) return find_fiducial_board(gray, board);
  // OpenCV only reads it.
  const cv::Mat picture(gray.height(), gray.width(), CV_8U, const_cast<std::uint8_t*>(gray.values().data()));
  Corners corners;
  BoardObservation observation;
  bool is_found = false;
  try {
    is_found = search_levels(picture, board, corners, observation);
  } catch (const cv::Exception&) {
    is_found = false;  // For example a picture too small for the search.
  }
  const auto is_inside = [&](const cv::Point2f& at) {
    return at.x >= 0 && at.y >= 0 && at.x <= static_cast<float>(gray.width() - 1) &&
           at.y <= static_cast<float>(gray.height() - 1);
  };
  if (!is_found ||
      corners.size() != static_cast<std::size_t>(board.columns) * static_cast<std::size_t>(board.rows) ||
      !std::ranges::all_of(corners, is_inside)) {
    if (observation.reason.empty())
      observation.reason = "the picture does not contain a complete board of this size";
    return observation;
  }
  for (const cv::Point2f& corner : corners) observation.pixels.emplace_back(corner.x, corner.y);
  if (goes_on(gray, board, observation.pixels))
    return {.pixels = {},
            .reason = "a part of a larger board: the pattern continues beyond the found points",
            .is_larger = true,
            .work = observation.work};
  order_as_seen(gray, board, observation.pixels);
  return observation;
}

}  // namespace flexura
