#pragma once

#include <cstddef>
#include <vector>

namespace flexura {

/// A piecewise cubic curve through points, with a continuous slope and without overshoot. Between two points
/// the curve increases if the points increase, and decreases if the points decrease (Fritsch, Butland, "A
/// method for constructing local monotone piecewise cubic interpolants", 1984). The slope at each end is
/// computed from three points and limited so that the end piece is monotone. For points on a straight line,
/// the curve is this line.
class MonotoneCubic {
 public:
  /// Makes the curve through the points (x[i], y[i]). With a single point, the curve is constant. Throws
  /// std::invalid_argument for no points, unequal numbers of x and y, numbers that are not finite, or x that
  /// does not strictly increase.
  MonotoneCubic(std::vector<double> x, std::vector<double> y);

  /// Smallest and largest x of the points.
  [[nodiscard]] double front() const { return x_.front(); }
  [[nodiscard]] double back() const { return x_.back(); }

  /// Returns the value of the curve at x; outside [front(), back()], the value at the nearest end.
  [[nodiscard]] double value(double x) const;
  /// Returns the slope dy/dx at x; 0 outside [front(), back()].
  [[nodiscard]] double slope(double x) const;
  /// Returns the derivative of value(x) with respect to y[i]. At a local extremum or between equal values,
  /// the rule for the slope at a point is not smooth. At such points, the slope counts as constant.
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
