#include "flexura/math/monotone_cubic.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

// The slope at an end of the curve: that of the parabola through three points, limited so that the piece is
// monotone. `near` and `far` are the widths and slopes of the first and second piece.
double end_slope(double near_width, double near_slope, double far_width, double far_slope) {
  const double slope =
      ((2 * near_width + far_width) * near_slope - near_width * far_slope) / (near_width + far_width);
  if (slope * near_slope <= 0) return 0;
  const bool turns = near_slope * far_slope < 0;
  return turns && std::abs(slope) > 3 * std::abs(near_slope) ? 3 * near_slope : slope;
}

// The slope at a point between two pieces: their harmonic mean, weighted by widths; 0 at a turn.
double inner_slope(double width, double slope, double next_width, double next_slope) {
  if (slope == 0 || next_slope == 0 || (slope > 0) != (next_slope > 0)) return 0;
  const double weight = 2 * next_width + width, next_weight = next_width + 2 * width;
  return (weight + next_weight) / (weight / slope + next_weight / next_slope);
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
    if (!(widths[i] > 0)) throw std::invalid_argument("the points of a curve must rise in x");
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

MonotoneCubic::Piece MonotoneCubic::piece_at(double x) const {
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(x_, x) - x_.begin());
  const std::size_t i = std::min(std::max<std::size_t>(after, 1), x_.size() - 1) - 1;
  return {x_[i], x_[i + 1] - x_[i], y_[i], y_[i + 1] - y_[i], slopes_[i], slopes_[i + 1]};
}

double MonotoneCubic::value(double x) const {
  if (!(x > x_.front())) return y_.front();
  if (x >= x_.back()) return y_.back();
  const Piece piece = piece_at(x);
  const double u = (x - piece.start) / piece.width, v = 1 - u;
  // The Hermite cubic, written as the chord and what bends it.
  return piece.y + u * u * (3 - 2 * u) * piece.rise +
         piece.width * u * v * (piece.slope * v - piece.end_slope * u);
}

double MonotoneCubic::slope(double x) const {
  if (x_.size() == 1 || !(x >= x_.front()) || x > x_.back()) return 0;
  const Piece piece = piece_at(x);
  const double u = (x - piece.start) / piece.width, v = 1 - u;
  return 6 * u * v * piece.rise / piece.width + piece.slope * v * (1 - 3 * u) -
         piece.end_slope * u * (3 * v - 1);
}

}  // namespace flexura
