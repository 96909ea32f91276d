#include "flexura/math/monotone_cubic.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

// Returns the slope at an end of the curve: the slope of the parabola through three points, limited so that
// the end piece is monotone. `near` has width and slope of the end piece, `far` of the piece next to it.
double end_slope(double near_width, double near_slope, double far_width, double far_slope) {
  const double slope =
      ((2 * near_width + far_width) * near_slope - near_width * far_slope) / (near_width + far_width);
  if (slope * near_slope <= 0) return 0;
  const bool turns = near_slope * far_slope < 0;
  return turns && std::abs(slope) > 3 * std::abs(near_slope) ? 3 * near_slope : slope;
}

// Returns the slope at a point between two pieces: the harmonic mean of the pieces' slopes, weighted by
// widths; 0 at an extremum.
double inner_slope(double width, double slope, double next_width, double next_slope) {
  if (slope == 0 || next_slope == 0 || (slope > 0) != (next_slope > 0)) return 0;
  const double weight = 2 * next_width + width, next_weight = next_width + 2 * width;
  return (weight + next_weight) / (weight / slope + next_weight / next_slope);
}

// Derivatives of such a slope with respect to the slopes of the two pieces.
struct SlopeChange {
  double by_first = 0, by_second = 0;
};

SlopeChange end_slope_change(double near_width, double near_slope, double far_width, double far_slope) {
  const double slope = end_slope(near_width, near_slope, far_width, far_slope);
  if (slope == 0) return {};
  if (slope == 3 * near_slope) return {3, 0};
  const double whole = near_width + far_width;
  return {(near_width + whole) / whole, -near_width / whole};
}

SlopeChange inner_slope_change(double width, double slope, double next_width, double next_slope) {
  const double mean = inner_slope(width, slope, next_width, next_slope);
  if (mean == 0) return {};
  const double weight = 2 * next_width + width, next_weight = next_width + 2 * width;
  const double share = mean * mean / (weight + next_weight);
  return {share * weight / (slope * slope), share * next_weight / (next_slope * next_slope)};
}

bool are_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::vector<double> x, std::vector<double> y)
    : x_(std::move(x)), y_(std::move(y)), slopes_(x_.size(), 0) {
  if (x_.empty() || x_.size() != y_.size() || !are_finite(x_) || !are_finite(y_))
    throw std::invalid_argument("a curve needs points, each of two finite numbers");
  std::vector<double> widths, slopes;
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    widths.push_back(x_[i + 1] - x_[i]);
    if (!(widths[i] > 0)) throw std::invalid_argument("the x of a curve's points must increase");
    slopes.push_back((y_[i + 1] - y_[i]) / widths[i]);
  }
  const std::size_t last = slopes.size();
  if (last == 0) return;
  if (last == 1) {
    slopes_.assign(2, slopes[0]);
    return;
  }
  slopes_[0] = end_slope(widths[0], slopes[0], widths[1], slopes[1]);
  for (std::size_t i = 1; i < last; ++i)
    slopes_[i] = inner_slope(widths[i - 1], slopes[i - 1], widths[i], slopes[i]);
  slopes_[last] = end_slope(widths[last - 1], slopes[last - 1], widths[last - 2], slopes[last - 2]);
}

std::size_t MonotoneCubic::start_of_piece(double x) const {
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(x_, x) - x_.begin());
  return std::min(std::max<std::size_t>(after, 1), x_.size() - 1) - 1;
}

MonotoneCubic::Piece MonotoneCubic::piece_at(double x) const {
  const std::size_t i = start_of_piece(x);
  return {x_[i], x_[i + 1] - x_[i], y_[i], y_[i + 1] - y_[i], slopes_[i], slopes_[i + 1]};
}

double MonotoneCubic::value(double x) const {
  if (!(x > x_.front())) return y_.front();
  if (x >= x_.back()) return y_.back();
  const Piece piece = piece_at(x);
  const double u = (x - piece.start) / piece.width, v = 1 - u;
  // Evaluates the Hermite cubic as the chord plus a correction.
  return piece.y + u * u * (3 - 2 * u) * piece.rise +
         piece.width * u * v * (piece.slope * v - piece.end_slope * u);
}

double MonotoneCubic::chord_slope(std::size_t piece) const {
  return (y_[piece + 1] - y_[piece]) / (x_[piece + 1] - x_[piece]);
}

// Returns d slopes_[at] / d y_[i].
double MonotoneCubic::slope_by_point(std::size_t at, std::size_t i) const {
  const auto width = [this](std::size_t piece) { return x_[piece + 1] - x_[piece]; };
  const auto chord_by_point = [&](std::size_t piece) {
    if (i == piece) return -1 / width(piece);
    return i == piece + 1 ? 1 / width(piece) : 0.0;
  };
  const std::size_t last = x_.size() - 2;  // Piece.
  if (last == 0) return chord_by_point(0);
  std::size_t first = at, second = at;  // Pieces.
  SlopeChange change;
  if (at == 0) {
    second = 1;
    change = end_slope_change(width(0), chord_slope(0), width(1), chord_slope(1));
  } else if (at == last + 1) {
    first = last, second = last - 1;
    change = end_slope_change(width(first), chord_slope(first), width(second), chord_slope(second));
  } else {
    first = at - 1;
    change = inner_slope_change(width(first), chord_slope(first), width(second), chord_slope(second));
  }
  return change.by_first * chord_by_point(first) + change.by_second * chord_by_point(second);
}

double MonotoneCubic::by_point(double x, std::size_t i) const {
  if (!(x > x_.front())) return i == 0 ? 1 : 0;
  if (x >= x_.back()) return i + 1 == x_.size() ? 1 : 0;
  const std::size_t start = start_of_piece(x);
  const double width = x_[start + 1] - x_[start], u = (x - x_[start]) / width, v = 1 - u;
  const double share = u * u * (3 - 2 * u);
  double change = width * u * v * (slope_by_point(start, i) * v - slope_by_point(start + 1, i) * u);
  if (i == start) change += 1 - share;
  if (i == start + 1) change += share;
  return change;
}

double MonotoneCubic::slope(double x) const {
  if (x_.size() == 1 || !(x >= x_.front()) || x > x_.back()) return 0;
  const Piece piece = piece_at(x);
  const double u = (x - piece.start) / piece.width, v = 1 - u;
  return 6 * u * v * piece.rise / piece.width + piece.slope * v * (1 - 3 * u) -
         piece.end_slope * u * (3 * v - 1);
}

}  // namespace flexura
