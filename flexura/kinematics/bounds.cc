#include "flexura/kinematics/bounds.h"

#include <algorithm>
#include <cmath>

namespace flexura {
namespace {

// Fraction of the bound's size. A value within this distance is at the bound.
constexpr double touching = 1e-9;

// Returns the outward unit normal of the bound at x if the bound holds x against -gradient; otherwise zero.
Eigen::Vector2d outward(const Bound& bound, const Eigen::VectorXd& x, const Eigen::VectorXd& gradient) {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  if (bound.size == 1) {
    const double reach = touching * (bound.high - bound.low);
    if (x[bound.at] >= bound.high - reach) normal.x() = 1.0;
    if (x[bound.at] <= bound.low + reach) normal.x() = -1.0;
    if (normal.x() * gradient[bound.at] >= 0.0) normal.x() = 0.0;
    return normal;
  }
  const Eigen::Vector2d u = x.segment<2>(bound.at);
  const double radius = u.norm();
  if (radius < bound.high * (1.0 - touching)) return normal;
  normal = u / radius;
  return normal.dot(gradient.segment<2>(bound.at)) < 0.0 ? normal : Eigen::Vector2d::Zero();
}

}  // namespace

void project(const Bounds& bounds, Eigen::VectorXd& x) {
  for (const Bound& bound : bounds) {
    if (bound.size == 1) {
      x[bound.at] = std::clamp(x[bound.at], bound.low, bound.high);
      continue;
    }
    auto u = x.segment<2>(bound.at);
    const double radius = u.norm();
    if (radius <= bound.high) continue;
    u *= bound.high / radius;
    // Rounding may leave the norm too large by one unit in the last place.
    while (u.norm() > bound.high) u *= 1.0 - 0x1p-52;
  }
}

double pressure(const Bounds& bounds, const Eigen::VectorXd& x, const Eigen::VectorXd& gradient) {
  double sum = 0.0;
  for (const Bound& bound : bounds) {
    const Eigen::Vector2d normal = outward(bound, x, gradient);
    const double out =
        bound.size == 1 ? normal.x() * gradient[bound.at] : normal.dot(gradient.segment<2>(bound.at));
    sum += out * out;
  }
  return std::sqrt(sum);
}

void free_gradient(const Bounds& bounds, const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
  for (const Bound& bound : bounds) {
    const Eigen::Vector2d normal = outward(bound, x, gradient);
    if (normal.isZero()) continue;
    if (bound.size == 1) {
      gradient[bound.at] = 0.0;
    } else {
      auto part = gradient.segment<2>(bound.at);
      part -= normal.dot(part) * normal;
    }
  }
}

}  // namespace flexura
