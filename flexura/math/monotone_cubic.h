#pragma once

#include <cstddef>
#include <vector>

namespace flexura {

/// A curve through points that does not overshoot between them. Each piece is a cubic, with a continuous
/// slope; the curve rises only where the points rise, and falls only where they fall. From F. N. Fritsch and
/// J. Butland, "A method for constructing local monotone piecewise cubic interpolants", 1984; slopes at the
/// ends are from three points, with the same limit. Through points of a straight line it is the line.
class MonotoneCubic {
 public:
  /// Through (x[i], y[i]). A single point gives a constant. Throws std::invalid_argument for fewer than one
  /// point, unequal counts, numbers that are not finite, or x that does not increase.
  MonotoneCubic(std::vector<double> x, std::vector<double> y);

  /// Return the first and the last x.
  [[nodiscard]] double front() const { return x_.front(); }
  [[nodiscard]] double back() const { return x_.back(); }

  /// Returns the value at x; outside [front(), back()] that of the nearest end.
  [[nodiscard]] double value(double x) const;
  /// Returns dy/dx; 0 outside.
  [[nodiscard]] double slope(double x) const;
  /// Returns d value(x) / d y[i]. Where a slope's rule is not smooth (points that turn or are level), that
  /// slope counts as constant.
  [[nodiscard]] double by_point(double x, std::size_t i) const;

 private:
  struct Piece {
    double start, width, y, rise, slope, end_slope;
  };
  [[nodiscard]] std::size_t start_of_piece(double x) const;
  [[nodiscard]] Piece piece_at(double x) const;
  [[nodiscard]] double chord_slope(std::size_t piece) const;
  [[nodiscard]] double slope_by_point(std::size_t at, std::size_t i) const;

  std::vector<double> x_, y_, slopes_;
};

}  // namespace flexura
