#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "flexura/board/board_target.h"

namespace flexura {

/// Largest number of pixels of a picture in which the search for a board starts, and in which it continues.
inline constexpr double first_search_pixels = 1.4e6, last_search_pixels = 5.6e6;

/// Reduced copies of a picture, each half as wide and high as the one before. The first is the original.
[[nodiscard]] std::vector<cv::Mat> reduced_pictures(const cv::Mat& picture);

/// Search for the points of a board with OpenCV, with a bound on its work.
class BoardSearch {
 public:
  explicit BoardSearch(const BoardTarget& board) : board_(board) {}

  /// Searches the points in one picture; returns whether they were found, in any order of rows and columns.
  bool find(const cv::Mat& picture, std::vector<cv::Point2f>& points);
  /// Moves the points to the nearest points of the pattern in the picture, with subpixel accuracy. Returns
  /// false if a point is lost.
  bool refine(const cv::Mat& picture, std::vector<cv::Point2f>& points) const;

  /// Returns the numbers of columns and rows of a grid of circles in the last picture that find() searched;
  /// (0, 0) if there is none, and for chessboards.
  [[nodiscard]] cv::Size other_grid() const;
  /// Returns the numbers of columns and rows of inner corners of a whole chessboard in a picture; (0, 0) if
  /// there is none.
  [[nodiscard]] static cv::Size other_chessboard(const cv::Mat& picture);

  /// Returns the work done by find() so far: pixels, plus 40 for each pair of dark or bright spots.
  [[nodiscard]] double work() const { return work_; }

 private:
  bool find_corners(const cv::Mat& picture, std::vector<cv::Point2f>& points);
  bool find_grid(cv::Size size, std::vector<cv::Point2f>& points) const;
  bool find_circles(const cv::Mat& picture, std::vector<cv::Point2f>& points);

  BoardTarget board_;
  std::vector<cv::Point2f> middles_;  // Of the dark spots in the last picture.
  double work_ = 0;
};

}  // namespace flexura
