#include "flexura/calibrate/zoom_correlation.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flexura/vision/threshold.h"

namespace flexura {
namespace {

// Returns the centroid of the pixels on the figure's side of the threshold.
std::optional<Eigen::Vector2d> figure_middle(const Image<std::uint8_t>& gray) {
  const Threshold threshold = threshold_of(gray, {});
  if (!threshold.reason.empty()) return std::nullopt;
  Eigen::Vector2d sum(0, 0);
  double count = 0;
  for (int v = 0; v < gray.height(); ++v) {
    for (int u = 0; u < gray.width(); ++u) {
      const bool is_dark = gray.at(u, v) <= threshold.level;
      if (is_dark == (threshold.figure == Figure::dark)) sum += Eigen::Vector2d(u, v), ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

// Normalised cross-correlation of two pictures, one of them enlarged.
class Correlator {
 public:
  Correlator(const Image<std::uint8_t>& real, const Image<std::uint8_t>& ideal, const Eigen::Vector2d& at,
             const Eigen::Vector2d& from)
      : real_(real), ideal_(ideal), at_(at), from_(from) {}

  // `pitch`: uses every pitch-th pixel of every pitch-th row.
  [[nodiscard]] double at(double ratio, int pitch) const {
    double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    for (int v = 0; v < real_.height(); v += pitch) {
      for (int u = 0; u < real_.width(); u += pitch) {
        const double a = real_.at(u, v);
        const double b = ideal((u - at_.x()) / ratio + from_.x(), (v - at_.y()) / ratio + from_.y());
        n += 1, sa += a, sb += b, saa += a * a, sbb += b * b, sab += a * b;
      }
    }
    const double variances = (n * saa - sa * sa) * (n * sbb - sb * sb);
    return variances > 0 ? (n * sab - sa * sb) / std::sqrt(variances) : 0;
  }

 private:
  // Bilinear interpolation; constant beyond the border.
  [[nodiscard]] double ideal(double u, double v) const {
    u = std::clamp(u, 0.0, ideal_.width() - 1.0), v = std::clamp(v, 0.0, ideal_.height() - 1.0);
    const int i = std::min(static_cast<int>(u), ideal_.width() - 2),
              j = std::min(static_cast<int>(v), ideal_.height() - 2);
    const double x = u - i, y = v - j;
    return (1 - y) * ((1 - x) * ideal_.at(i, j) + x * ideal_.at(i + 1, j)) +
           y * ((1 - x) * ideal_.at(i, j + 1) + x * ideal_.at(i + 1, j + 1));
  }
  const Image<std::uint8_t>&real_, &ideal_;
  Eigen::Vector2d at_, from_;
};

}  // namespace

ZoomCorrelation correlate_zoom(const Image<std::uint8_t>& real, const Image<std::uint8_t>& ideal) {
  if (real.channels() != 1 || ideal.channels() != 1 || real.width() != ideal.width() ||
      real.height() != ideal.height() || real.width() < 2 || real.height() < 2)
    throw std::invalid_argument("a correlation needs two gray pictures of equal size");
  ZoomCorrelation found;
  const auto at = figure_middle(real), from = figure_middle(ideal);
  if (!at || !from) {
    found.reason = "a picture has no figure to correlate";
    return found;
  }
  const Correlator correlator(real, ideal, *at, *from);
  // Full search in steps of 3 %, on every third pixel; then golden sections between the neighbours.
  constexpr int steps = 24, coarse = 3;
  const double step = std::numbers::ln2 / steps;
  int best = 0;
  double highest = -1;
  for (int i = -steps; i <= steps; ++i) {
    const double value = correlator.at(std::exp(i * step), coarse);
    if (value > highest) highest = value, best = i;
  }
  double low = (best - 1) * step, high = (best + 1) * step;
  constexpr double golden = 0.61803398874989485;
  constexpr int sections = 14;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = correlator.at(std::exp(a), 1), at_b = correlator.at(std::exp(b), 1);
  for (int i = 0; i < sections; ++i) {
    if (at_a > at_b) {
      high = std::exchange(b, a), at_b = at_a;
      a = high - golden * (high - low), at_a = correlator.at(std::exp(a), 1);
    } else {
      low = std::exchange(a, b), at_a = at_b;
      b = low + golden * (high - low), at_b = correlator.at(std::exp(b), 1);
    }
  }
  found.ratio = std::exp(0.5 * (low + high)), found.peak = std::max(at_a, at_b);
  constexpr double least = 0.5;
  if (found.peak < least)
    found.reason = fmt::format(
        "the largest correlation is {:.2f}: the picture does not show the expected arc", found.peak);
  return found;
}

}  // namespace flexura
