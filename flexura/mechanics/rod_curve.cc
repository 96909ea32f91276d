#include "flexura/mechanics/rod_curve.h"

#include <algorithm>
#include <cmath>

namespace flexura {
namespace {

// Slope by s, at place k, of the parabola through three places from `first` on.
struct CurveSlope {
  std::array<std::size_t, 3> places{};
  std::array<double, 3> weights{};
};

CurveSlope curve_slope_at(std::span<const double> s, std::size_t k) {
  if (s.size() == 2) return {.places = {0, 1, 1}, .weights = {-1 / (s[1] - s[0]), 1 / (s[1] - s[0]), 0}};
  const std::size_t middle = std::clamp<std::size_t>(k, 1, s.size() - 2);
  CurveSlope slope{.places = {middle - 1, middle, middle + 1}};
  // Derivatives of Lagrange polynomials.
  for (std::size_t i = 0; i < 3; ++i) {
    const double own = s[slope.places[i]], one = s[slope.places[(i + 1) % 3]],
                 other = s[slope.places[(i + 2) % 3]];
    slope.weights[i] = (2 * s[k] - one - other) / ((own - one) * (own - other));
  }
  return slope;
}

}  // namespace

RodCurve::RodCurve(std::span<const double> s) {
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    Segment& segment = segments_.emplace_back();
    const std::size_t last = s.size() - 1;
    segment.places = {k > 0 ? k - 1 : std::min(k + 2, last), k, k + 1,
                      k + 2 <= last ? k + 2 : k - (k > 0 ? 1 : 0)};
    const double length = s[k + 1] - s[k];
    const auto add = [&](std::size_t place, double factor, const Eigen::RowVector4d& form) {
      const auto at = std::ranges::find(segment.places, place) - segment.places.begin();
      segment.weights.row(at) += factor * form;
    };
    // Hermite cubics.
    add(k, 1, {1, 0, -3, 2});
    add(k + 1, 1, {0, 0, 3, -2});
    for (const bool is_end : {false, true}) {
      const CurveSlope slope = curve_slope_at(s, is_end ? k + 1 : k);
      for (std::size_t i = 0; i < 3; ++i)
        if (slope.weights[i] != 0)
          add(slope.places[i], length * slope.weights[i],
              is_end ? Eigen::RowVector4d(0, 0, -1, 1) : Eigen::RowVector4d(0, 1, -2, 1));
    }
  }
}

RodCurve::Piece RodCurve::piece(const Segment& segment, const std::array<Eigen::Vector3d, 4>& places) {
  Piece piece;
  piece.powers.setZero();
  for (std::size_t i = 0; i < 4; ++i)
    piece.powers += places[i] * segment.weights.row(static_cast<Eigen::Index>(i));
  // Inside the hull of the Bezier points.
  const Eigen::Vector3d begin = piece.at(0), end = piece.at(1), one = begin + piece.slope_at(0) / 3,
                        other = end - piece.slope_at(1) / 3;
  piece.middle = 0.5 * (begin + end);
  piece.reach = std::sqrt(std::max({(begin - piece.middle).squaredNorm(), (one - piece.middle).squaredNorm(),
                                    (other - piece.middle).squaredNorm()}));
  return piece;
}

}  // namespace flexura
