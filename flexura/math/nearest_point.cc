#include "flexura/math/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flexura {
namespace {

void check(const ConvexLimits& limits, Eigen::Index size) {
  for (const BallLimit& ball : limits.balls)
    if (ball.at < 0 || ball.at + ball.center.size() > size || !(ball.radius >= 0))
      throw std::invalid_argument(
          "the size of a ball differs from the size of the vector that the ball limits");
  for (const BandLimit& band : limits.bands)
    if (band.normal.size() != size)
      throw std::invalid_argument("the size of a band differs from the size of the vector");
}

// Returns by how much a band's product exceeds its limits; negative below the lower one.
double beyond(const BandLimit& band, double product) {
  return product > band.upper ? product - band.upper : std::min(0.0, product - band.lower);
}

}  // namespace

double excess(const ConvexLimits& limits, const Eigen::VectorXd& x) {
  double most = 0;
  for (const BallLimit& ball : limits.balls)
    most = std::max(most, (x.segment(ball.at, ball.center.size()) - ball.center).norm() - ball.radius);
  for (const BandLimit& band : limits.bands) {
    const double norm = band.normal.norm();
    if (norm > 0) most = std::max(most, std::abs(beyond(band, band.normal.dot(x))) / norm);
  }
  return most;
}

// Each set remembers by how much its last projection moved x, and starts the next one from there. Without
// this correction the result would be some common point instead of the nearest.
std::optional<Eigen::VectorXd> nearest_point(const ConvexLimits& limits, const Eigen::VectorXd& start,
                                             const NearestPointConfig& config) {
  check(limits, start.size());
  if (!start.allFinite()) return std::nullopt;
  Eigen::VectorXd x = start;
  std::vector<Eigen::VectorXd> moved_by_ball;
  moved_by_ball.reserve(limits.balls.size());
  for (const BallLimit& ball : limits.balls)
    moved_by_ball.emplace_back(Eigen::VectorXd::Zero(ball.center.size()));
  std::vector<double> moved_by_band(limits.bands.size(), 0.0);  // In units of the normal.
  std::vector<double> squares;
  squares.reserve(limits.bands.size());
  for (const BandLimit& band : limits.bands) squares.push_back(band.normal.squaredNorm());
  for (int round = 0; round < config.most_rounds; ++round) {
    double change = 0;
    for (std::size_t i = 0; i < limits.balls.size(); ++i) {
      const BallLimit& ball = limits.balls[i];
      auto part = x.segment(ball.at, ball.center.size());
      const Eigen::VectorXd from = part - moved_by_ball[i], way = from - ball.center;
      const double norm = way.norm();
      const Eigen::VectorXd to =
          norm > ball.radius ? Eigen::VectorXd(ball.center + ball.radius / norm * way) : from;
      change = std::max(change, (to - part).norm());
      moved_by_ball[i] = to - from;
      part = to;
    }
    for (std::size_t i = 0; i < limits.bands.size(); ++i) {
      const BandLimit& band = limits.bands[i];
      if (!(squares[i] > 0)) continue;
      const double product = band.normal.dot(x) - moved_by_band[i] * squares[i];
      const double move = -beyond(band, product) / squares[i];
      const double step = move - moved_by_band[i];
      change = std::max(change, std::abs(step) * std::sqrt(squares[i]));
      x += step * band.normal;
      moved_by_band[i] = move;
    }
    if (change <= config.tolerance && excess(limits, x) <= config.tolerance) return x;
  }
  return excess(limits, x) <= config.tolerance ? std::optional(x) : std::nullopt;
}

}  // namespace flexura
