#include "flexura/board/fiducial_board.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "flexura/base/names.h"
#include "flexura/board/board_search.h"
#include "flexura/board/board_start.h"
#include "flexura/board/fiducial_finder.h"

namespace flexura {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

// How the markers of a picture correspond to the board's.
struct Assignment {
  std::vector<FoundFiducial> markers;  // Those that agree, with the first corner as on the board.
  double rms = 0;                      // Of their corners, in sides of the markers.

  [[nodiscard]] bool is_better_than(const Assignment& other) const {
    if (markers.size() != other.markers.size()) return markers.size() > other.markers.size();
    return rms < other.rms;
  }
};

std::optional<Matrix3d> homography_of(const std::vector<FoundFiducial>& markers,
                                      const FiducialPlaces& places) {
  std::vector<Vector2d> points, pixels;
  for (const FoundFiducial& marker : markers) {
    const auto& place = places[static_cast<std::size_t>(marker.id)];
    points.insert(points.end(), place.begin(), place.end());
    pixels.insert(pixels.end(), marker.corners.begin(), marker.corners.end());
  }
  if (points.empty()) return std::nullopt;
  return board_homography(points, pixels);
}

// Root mean square distance of a marker's corners from where the homography has them, in sides of the marker.
double residual_of(const FoundFiducial& marker, const FiducialPlaces& places, const Matrix3d& H) {
  double squares = 0, side = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d expected =
        (H * places[static_cast<std::size_t>(marker.id)][i].homogeneous()).hnormalized();
    squares += 0.25 * (expected - marker.corners[i]).squaredNorm();
    side += 0.25 * (marker.corners[(i + 1) % 4] - marker.corners[i]).norm();
  }
  return std::sqrt(squares) / side;
}

// Keeps the markers that agree with one homography. A lens bends the board's image by less than the last
// bound.
Assignment agreeing(std::vector<FoundFiducial> markers, const FiducialPlaces& places) {
  Assignment result;
  for (const double most : {3.0, 1.5, 0.8, 0.5, 0.5}) {
    const auto H = homography_of(markers, places);
    if (!H) return {};
    std::erase_if(markers,
                  [&](const FoundFiducial& marker) { return !(residual_of(marker, places, *H) <= most); });
  }
  const auto H = homography_of(markers, places);
  if (!H) return {};
  double squares = 0;
  for (const FoundFiducial& marker : markers) squares += std::pow(residual_of(marker, places, *H), 2);
  result.rms = std::sqrt(squares / static_cast<double>(markers.size()));
  result.markers = std::move(markers);
  return result;
}

std::vector<FoundFiducial> turned(std::vector<FoundFiducial> markers, std::size_t turns) {
  for (FoundFiducial& marker : markers)
    std::ranges::rotate(marker.corners, marker.corners.begin() + static_cast<std::ptrdiff_t>(turns));
  return markers;
}

// A reduced copy of the picture, and how often its size was halved.
struct Level {
  const cv::Mat* picture = nullptr;
  std::size_t number = 0;
};

std::vector<Level> levels_of(const std::vector<cv::Mat>& pictures) {
  std::size_t first = 0;
  while (first + 1 < pictures.size() && static_cast<double>(pictures[first].total()) > first_search_pixels)
    ++first;
  std::vector<Level> levels = {{&pictures[first], first}};
  if (first > 0 && static_cast<double>(pictures[first - 1].total()) <= last_search_pixels)
    levels.push_back({&pictures[first - 1], first - 1});
  return levels;
}

Vector2d up(const Vector2d& pixel, std::size_t levels) {
  Vector2d result = pixel;
  for (; levels > 0; --levels) result = 2 * result + Vector2d(0.5, 0.5);
  return result;
}

// The inner corners of a ChArUco board.
class ChessCorners {
 public:
  ChessCorners(const BoardTarget& board, const FiducialPlaces& places,
               const std::vector<FoundFiducial>& markers)
      : board_(board), places_(places), markers_(markers) {}

  // Returns the corner near `point`, in the picture in which the markers were found; empty if it is not
  // visible.
  [[nodiscard]] std::optional<Vector2d> find(const cv::Mat& gray, const Vector2d& point) const {
    std::vector<FoundFiducial> near;
    for (const FoundFiducial& marker : markers_) {
      const auto& place = places_[static_cast<std::size_t>(marker.id)];
      const Vector2d middle = 0.25 * (place[0] + place[1] + place[2] + place[3]);
      if ((middle - point).lpNorm<Eigen::Infinity>() < 0.75 * board_.square) near.push_back(marker);
    }
    const auto H = homography_of(near, places_);
    if (!H) return std::nullopt;
    const Vector2d expected = image(*H, point);
    // Markers begin this far from the corner.
    const double gap = 0.5 * (board_.square - board_.marker);
    double pixels = std::numeric_limits<double>::infinity();
    for (const Vector2d& step : {Vector2d(gap, 0), Vector2d(-gap, 0), Vector2d(0, gap), Vector2d(0, -gap)})
      pixels = std::min(pixels, (image(*H, point + step) - expected).norm());
    auto corner = refined(gray, expected, pixels);
    if (!corner || !is_saddle(gray, *H, point, gap, *corner - expected)) return std::nullopt;
    return corner;
  }

  // Moves a corner to the saddle point nearby. `gap`: distance of the nearest markers, px.
  [[nodiscard]] static std::optional<Vector2d> refined(const cv::Mat& gray, const Vector2d& at, double gap) {
    constexpr double least = 2, most = 5;
    const int half = static_cast<int>(std::clamp(gap - 1, least, most));
    const int border = half + 2;
    const bool is_inside =
        at.x() >= border && at.y() >= border && at.x() < gray.cols - border && at.y() < gray.rows - border;
    if (!is_inside) return std::nullopt;
    std::vector<cv::Point2f> corner = {{static_cast<float>(at.x()), static_cast<float>(at.y())}};
    cv::cornerSubPix(gray, corner, {half, half}, {-1, -1},
                     cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-6));
    std::optional<Vector2d> result(std::in_place, corner[0].x, corner[0].y);
    if ((*result - at).norm() > std::max(least, 0.5 * gap)) return std::nullopt;
    return result;
  }

 private:
  static Vector2d image(const Matrix3d& H, const Vector2d& point) {
    return (H * point.homogeneous()).hnormalized();
  }

  // Returns whether opposite squares at a corner are alike and neighbours are not: otherwise something hides
  // it.
  static bool is_saddle(const cv::Mat& gray, const Matrix3d& H, const Vector2d& point, double gap,
                        const Vector2d& shift) {
    constexpr double least_contrast = 15;  // Of 255.
    std::array<double, 4> around{};
    const std::array<Vector2d, 4> ways = {Vector2d(1, 1), {-1, 1}, {-1, -1}, {1, -1}};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d at = image(H, point + 0.7 * gap * ways[i]) + shift;
      const int u = static_cast<int>(std::lround(at.x())), v = static_cast<int>(std::lround(at.y()));
      if (u < 0 || v < 0 || u >= gray.cols || v >= gray.rows) return false;
      around[i] = gray.at<std::uint8_t>(v, u);
    }
    const double high = std::min(around[0], around[2]) - std::max(around[1], around[3]),
                 low = std::min(around[1], around[3]) - std::max(around[0], around[2]);
    return std::max(high, low) > least_contrast;
  }

  const BoardTarget& board_;
  const FiducialPlaces& places_;
  const std::vector<FoundFiducial>& markers_;
};

// The image of a board's markers, and the layout that explains it.
struct Fitted {
  Assignment assignment;
  FiducialPlaces places;
  bool is_unique = true;
};

Fitted fitted(const std::vector<FoundFiducial>& markers, const std::vector<FiducialPlaces>& layouts) {
  Fitted best;
  std::optional<Assignment> second;
  for (const FiducialPlaces& places : layouts) {
    for (std::size_t turns = 0; turns < 4; ++turns) {
      Assignment one = agreeing(turned(markers, turns), places);
      if (one.markers.empty()) continue;
      const bool is_best = best.assignment.markers.empty() || one.is_better_than(best.assignment);
      if (is_best) std::swap(one, best.assignment), best.places = places;
      if (!one.markers.empty() && (!second || one.is_better_than(*second))) second = std::move(one);
    }
  }
  // Two layouts may explain a few markers equally well.
  constexpr double clearly = 2;
  best.is_unique = !second || second->markers.size() < best.assignment.markers.size() ||
                   second->rms > clearly * best.assignment.rms + 0.02;
  return best;
}

}  // namespace

std::vector<FiducialPlaces> fiducial_layouts(const BoardTarget& board) {
  const auto corners = [&](const Vector2d& middle) {
    const double half = 0.5 * board.marker;
    return std::array<Vector2d, 4>{middle + Vector2d(-half, -half), middle + Vector2d(half, -half),
                                   middle + Vector2d(half, half), middle + Vector2d(-half, half)};
  };
  std::vector<FiducialPlaces> layouts(2);
  if (board.pattern == BoardPattern::charuco) {
    for (int row = 0; row <= board.rows; ++row)
      for (int column = 0; column <= board.columns; ++column)
        layouts[(row + column) % 2 == 1 ? 0 : 1].push_back(
            corners(board.square * Vector2d(column - 0.5, row - 0.5)));
    return layouts;
  }
  const auto middle = [&](int column, int row) {
    return Vector2d(board.square * Vector2d(column, row) + 0.5 * board.marker * Vector2d::Ones());
  };
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      layouts[0].push_back(corners(middle(column, row)));
      layouts[1].push_back(corners(middle(column, board.rows - 1 - row)));
    }
  }
  return layouts;
}

BoardObservation find_fiducial_board(const Image<std::uint8_t>& gray, const BoardTarget& board) {
  constexpr std::size_t least_markers = 2, least_points = 6;
  // OpenCV only reads it.
  const cv::Mat picture(gray.height(), gray.width(), CV_8U, const_cast<std::uint8_t*>(gray.values().data()));
  const std::vector<cv::Mat> pictures = reduced_pictures(picture);
  const std::vector<FiducialPlaces> layouts = fiducial_layouts(board);
  const int count = static_cast<int>(std::max(layouts[0].size(), layouts[1].size()));
  BoardObservation observation;
  Fitted best;
  Level level;
  std::size_t found = 0;
  for (const Level& tried : levels_of(pictures)) {
    // A larger picture costs four times as much: only if markers are missing.
    if (2 * best.assignment.markers.size() > layouts[0].size()) break;
    const auto markers = find_fiducials(*tried.picture, board.family, count);
    observation.work += static_cast<double>(tried.picture->total());
    Fitted one = fitted(markers, layouts);
    found = std::max(found, markers.size());
    if (level.picture == nullptr || one.assignment.is_better_than(best.assignment))
      best = std::move(one), level = tried;
  }
  const std::vector<FoundFiducial>& markers = best.assignment.markers;
  // A few markers of another board may agree by chance, such as three in a row.
  if (markers.size() < least_markers || 2 * markers.size() <= found || !best.is_unique) {
    const std::string family = name_of(board.family);
    if (found == 0) {
      observation.reason =
          fmt::format("the picture shows no marker of the family {} with a number below {}", family, count);
    } else if (found < least_markers) {
      observation.reason = "the picture shows only one marker of the board";
    } else {
      observation.reason = fmt::format(
          "the picture shows {} markers of the family {}, but their numbers do not fit a board of {}x{}",
          found, family, board.columns, board.rows);
    }
    return observation;
  }
  const Vector2d missing = Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  const std::vector<Vector2d> points = board.points();
  std::vector<Vector2d> pixels(points.size(), missing);
  if (board.pattern == BoardPattern::charuco) {
    const ChessCorners corners(board, best.places, markers);
    for (std::size_t i = 0; i < points.size(); ++i) {
      auto corner = corners.find(*level.picture, points[i]);
      for (std::size_t k = level.number; corner && k > 0; --k)
        corner = ChessCorners::refined(pictures[k - 1], up(*corner, 1), 5);
      if (corner) pixels[i] = *corner;
    }
  } else {
    for (const FoundFiducial& marker : markers) {
      Quad quad = marker.corners;
      constexpr double reach = 3;  // px
      bool is_seen = true;
      for (std::size_t k = level.number; is_seen && k > 0; --k) {
        for (Vector2d& corner : quad) corner = up(corner, 1);
        is_seen = refine_quad(pictures[k - 1], reach, quad);
      }
      // Where the marker is in the order of the points: rows from the top in all layouts.
      const Vector2d first = best.places[static_cast<std::size_t>(marker.id)][0] / board.square;
      const auto place =
          static_cast<std::size_t>(std::lround(first.y()) * board.columns + std::lround(first.x()));
      if (is_seen) std::ranges::copy(quad, pixels.begin() + static_cast<std::ptrdiff_t>(4 * place));
    }
  }
  const auto seen = std::ranges::count_if(pixels, [](const Vector2d& pixel) { return pixel.allFinite(); });
  if (static_cast<std::size_t>(seen) < least_points) {
    observation.reason =
        fmt::format("the picture shows only {} points of the board: expected {} or more", seen, least_points);
    return observation;
  }
  observation.pixels = std::move(pixels);
  return observation;
}

}  // namespace flexura
