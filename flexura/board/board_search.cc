#include "flexura/board/board_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace flexura {
namespace {

using Points = std::vector<cv::Point2f>;

// OpenCV's search of squares compares all pairs of spots several hundred times: half a second for this
// number.
constexpr std::size_t most_spots = 250;
constexpr double work_per_pair = 40;

// Returns the smallest distance of neighbours in a row or a column, px.
double least_spacing(const Points& points, const BoardTarget& board) {
  double least = std::numeric_limits<double>::infinity();
  const auto columns = static_cast<std::size_t>(board.columns);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % columns != 0) least = std::min(least, cv::norm(points[i] - points[i - 1]));
    if (i >= columns) least = std::min(least, cv::norm(points[i] - points[i - columns]));
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

// Returns the number of spots that OpenCV's search of squares would take for squares: connected parts of the
// thresholded picture of 25 px^2 or more.
std::size_t spots_of(const cv::Mat& picture) {
  cv::Mat equal, parts;
  cv::equalizeHist(picture, equal);
  std::size_t most = 0;
  for (const double share : {0.1, 0.2}) {
    const int block = static_cast<int>(share * std::min(picture.cols, picture.rows)) | 1;
    if (block < 3) return 0;
    cv::adaptiveThreshold(equal, parts, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY, block, 0);
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(parts, outlines, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
    constexpr double smallest = 25;
    const auto count = std::ranges::count_if(
        outlines, [](const auto& outline) { return cv::contourArea(outline) >= smallest; });
    most = std::max(most, static_cast<std::size_t>(count));
  }
  return most;
}

// Returns the largest contrast of areas that count as even: twice the contrast that half of the picture does
// not exceed, but at most a tenth of the largest.
double even_contrast(const cv::Mat& contrast) {
  constexpr double least = 4;
  std::array<std::size_t, 256> counts{};
  const cv::Mat_<std::uint8_t> values(contrast);
  for (const std::uint8_t value : values) ++counts[value];
  std::size_t middle = 0, largest = 255, sum = counts[0];
  while (2 * sum < contrast.total()) sum += counts[++middle];
  while (largest > 0 && counts[largest] == 0) --largest;
  return std::max(least, std::min(2.0 * static_cast<double>(middle), 0.1 * static_cast<double>(largest)));
}

// Returns the picture without the noise of even areas. OpenCV's threshold is the mean around a pixel: it
// would make a spot of each grain, and then search squares in each of them for minutes. Edges stay.
cv::Mat without_grain(const cv::Mat& picture) {
  constexpr int near = 7, wide = 15, step = 16;
  cv::Mat smooth, high, low, even, result;
  cv::GaussianBlur(picture, smooth, {5, 5}, 1.2);
  const cv::Mat around = cv::getStructuringElement(cv::MORPH_RECT, {near, near});
  cv::dilate(smooth, high, around);
  cv::erode(smooth, low, around);
  const cv::Mat contrast = high - low;
  cv::compare(contrast, even_contrast(contrast), even, cv::CMP_LE);
  cv::medianBlur(smooth, result, wide);
  // Steps, so that the rest of the noise vanishes, too.
  result.forEach<std::uint8_t>([](std::uint8_t& value, const int*) {
    value = static_cast<std::uint8_t>(value / step * step + step / 2);
  });
  picture.copyTo(result, ~even);
  return result;
}

cv::Ptr<cv::SimpleBlobDetector> circle_detector(const cv::Mat& picture, const BoardTarget& board) {
  // OpenCV's default limits are for pictures of 640 x 480 px.
  cv::SimpleBlobDetector::Params blobs;
  blobs.minArea = 10;
  blobs.maxArea = static_cast<float>(picture.total()) / static_cast<float>(board.columns);
  blobs.minDistBetweenBlobs = 3;
  return cv::SimpleBlobDetector::create(blobs);
}

// Moves each point to the middle of the circle around it.
bool refine_circles(const cv::Mat& picture, const BoardTarget& board, Points& points) {
  // Neighbours of asymmetric circles are in the next row.
  const double half = 0.45 * least_spacing(points, board);
  for (cv::Point2f& point : points) {
    const cv::Rect around = cv::Rect(static_cast<int>(point.x - half), static_cast<int>(point.y - half),
                                     static_cast<int>(2 * half) + 1, static_cast<int>(2 * half) + 1) &
                            cv::Rect(0, 0, picture.cols, picture.rows);
    std::vector<cv::KeyPoint> blobs;
    if (around.width < 5 || around.height < 5) return false;
    const cv::Mat window = picture(around).clone();
    auto detector = circle_detector(window, {.columns = 1});
    detector->detect(window, blobs);
    const cv::Point2f corner(static_cast<float>(around.x), static_cast<float>(around.y));
    const auto nearest = std::ranges::min_element(
        blobs, {}, [&](const cv::KeyPoint& blob) { return cv::norm(blob.pt + corner - point); });
    if (nearest == blobs.end() || cv::norm(nearest->pt + corner - point) > 0.5 * half) return false;
    point = nearest->pt + corner;
  }
  return true;
}

}  // namespace

std::vector<cv::Mat> reduced_pictures(const cv::Mat& picture) {
  constexpr int least = 100;  // px
  std::vector<cv::Mat> pictures = {picture};
  while (std::min(pictures.back().cols, pictures.back().rows) >= 2 * least) {
    const cv::Mat& last = pictures.back();
    const cv::Size half(last.cols / 2, last.rows / 2);
    cv::Mat reduced;
    cv::resize(last(cv::Rect(0, 0, 2 * half.width, 2 * half.height)), reduced, half, 0, 0, cv::INTER_AREA);
    pictures.push_back(reduced);
  }
  return pictures;
}

bool BoardSearch::find(const cv::Mat& picture, Points& points) {
  points.clear();
  work_ += static_cast<double>(picture.total());
  const bool is_found = board_.pattern == BoardPattern::chessboard ? find_corners(picture, points)
                                                                   : find_circles(picture, points);
  return is_found &&
         points.size() == static_cast<std::size_t>(board_.columns) * static_cast<std::size_t>(board_.rows);
}

bool BoardSearch::find_corners(const cv::Mat& picture, Points& points) {
  const cv::Size size(board_.columns, board_.rows);
  const cv::Mat searched = without_grain(picture);
  const std::size_t spots = spots_of(searched);
  // In clutter the search by sectors is faster.
  if (spots > most_spots) return cv::findChessboardCornersSB(searched, size, points, 0);
  work_ += work_per_pair * static_cast<double>(spots * spots);
  if (cv::findChessboardCorners(searched, size, points,
                                cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE))
    return true;
  // The search of squares needs a bright border around the board.
  if (static_cast<double>(picture.total()) > first_search_pixels) return false;
  work_ += static_cast<double>(picture.total());
  return cv::findChessboardCornersSB(picture, size, points, 0);
}

cv::Size BoardSearch::other_chessboard(const cv::Mat& picture) {
  constexpr int least = 3;
  Points points;
  cv::Mat kinds;  // One per corner.
  if (!cv::findChessboardCornersSB(picture, {least, least}, points, cv::CALIB_CB_LARGER, kinds))
    return {0, 0};
  return kinds.size();
}

bool BoardSearch::find_circles(const cv::Mat& picture, Points& points) {
  std::vector<cv::KeyPoint> blobs;
  circle_detector(picture, board_)->detect(picture, blobs);
  middles_.clear();
  if (blobs.size() > std::max(most_spots, 4 * board_.points().size())) return false;
  work_ += work_per_pair * static_cast<double>(blobs.size() * blobs.size());
  for (const cv::KeyPoint& blob : blobs) middles_.push_back(blob.pt);
  if (find_grid({board_.columns, board_.rows}, points)) return true;
  if (board_.pattern != BoardPattern::circles || !find_grid({board_.rows, board_.columns}, points))
    return false;
  // The grid is turned: its rows are the board's columns.
  const auto columns = static_cast<std::size_t>(board_.columns), rows = static_cast<std::size_t>(board_.rows);
  Points turned;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) turned.push_back(points[column * rows + row]);
  points = turned;
  return true;
}

bool BoardSearch::find_grid(cv::Size size, Points& points) const {
  // The search for the grid uses random numbers: equal ones for every picture.
  cv::setRNGSeed(1);
  const int kind =
      board_.pattern == BoardPattern::circles ? cv::CALIB_CB_SYMMETRIC_GRID : cv::CALIB_CB_ASYMMETRIC_GRID;
  return cv::findCirclesGrid(middles_, size, points, kind, cv::Ptr<cv::FeatureDetector>());
}

cv::Size BoardSearch::other_grid() const {
  constexpr int least = 3, most = 50;
  constexpr std::size_t most_middles = 200;  // For more, each grid takes a second.
  if (middles_.size() > most_middles) return {0, 0};
  const int count = static_cast<int>(middles_.size());
  Points points;
  for (int rows = least; rows <= most && rows * least <= count; ++rows) {
    if (count % rows != 0 || count / rows > most) continue;
    if (find_grid({count / rows, rows}, points)) return {count / rows, rows};
  }
  return {0, 0};
}

bool BoardSearch::refine(const cv::Mat& picture, Points& points) const {
  if (board_.pattern != BoardPattern::chessboard) return refine_circles(picture, board_, points);
  const int half = half_window(least_spacing(points, board_));
  cv::cornerSubPix(picture, points, {half, half}, {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-6));
  return true;
}

}  // namespace flexura
