#pragma once

#include <cstddef>
#include <vector>

namespace flexura {

/// A curve through points that never swings out between them: a cubic on each piece, with a continuous slope,
/// rising only where the points rise and falling only where they fall (F. N. Fritsch and J. Butland, "A
/// method for constructing local monotone piecewise cubic interpolants", 1984; slopes at the ends by three
/// points, limited likewise). Through points of a straight line it is the line.
class MonotoneCubic {
 public:
  /// Through (x[i], y[i]). std::invalid_argument: fewer than one point, unequal counts, numbers that are not
  /// finite, x that does not rise. A single point makes a constant.
  MonotoneCubic(std::vector<double> x, std::vector<double> y);

  /// The first and the last x.
  [[nodiscard]] double front() const { return x_.front(); }
  [[nodiscard]] double back() const { return x_.back(); }

  /// At x; outside [front(), back()] it goes on as at the nearest end.
  [[nodiscard]] double value(double x) const;
  /// dy/dx; 0 outside.
  [[nodiscard]] double slope(double x) const;
  /// d value(x) / d y[i]. Where a slope's rule has a corner (points that turn or are level), that slope is
  /// taken to stay.
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
