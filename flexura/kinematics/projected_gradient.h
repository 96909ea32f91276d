#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "flexura/kinematics/bounded_least_squares.h"

namespace flexura {

/// Descends from x within `bounds` by spectral projected gradients (Birgin, Martinez, Raydan 2000: Barzilai-
/// Borwein steps, projected, with a search that forgives the last few rises). For minima with a large
/// residual, the nearest pose to a target out of reach: there Gauss-Newton's model of the curvature is wrong
/// by the residual itself. Afterwards x is the best point seen, and memory.r and .J are those of x.
template <class Problem>
Descent descend_gradient(Problem& problem, const Bounds& bounds, const DescentLimits& limits,
                         Eigen::VectorXd& x, DescentMemory<Problem>& memory) {
  const auto evaluate = [&](const Eigen::VectorXd& at) {
    problem.linearise(at, memory.r, memory.J);
    ++memory.iterations;
    memory.gradient.noalias() = memory.J.transpose() * memory.r;
    return 0.5 * memory.r.squaredNorm();
  };
  std::array<double, 8> recent{};
  double value = evaluate(x);
  recent.fill(value);
  double best_value = value;
  Eigen::VectorXd best = x;
  double length = 1.0 / std::max(1.0, memory.gradient.norm());
  Descent ended = Descent::exhausted;
  for (int i = 0; i < limits.iterations; ++i) {
    if (problem.is_met(memory.r)) {
      ended = Descent::met;
      break;
    }
    Eigen::VectorXd& direction = memory.step;
    direction = x - length * memory.gradient;
    project(bounds, direction);
    direction -= x;
    // The fixed points of the projected gradient step are the constrained minima.
    if (direction.norm() <= limits.slope * length * memory.r.norm()) {
      ended = Descent::stationary;
      break;
    }
    const double slope = memory.gradient.dot(direction);
    const double highest = *std::ranges::max_element(recent);
    memory.offset = memory.gradient;
    double part = 1.0;
    for (int halving = 0; halving < 40; ++halving, part *= 0.5) {
      memory.trial = x + part * direction;
      project(bounds, memory.trial);
      value = evaluate(memory.trial);
      if (value <= highest + 1e-4 * part * slope) break;
    }
    const double square = (memory.trial - x).squaredNorm();
    const double curvature = (memory.trial - x).dot(memory.gradient - memory.offset);
    length = curvature > 1e-10 * square ? std::min(square / curvature, 1e6) : std::min(10 * length, 1e6);
    x.swap(memory.trial);
    recent[static_cast<std::size_t>(i) % recent.size()] = value;
    if (value < best_value) {
      best_value = value;
      best = x;
    }
  }
  x = best;
  evaluate(x);
  return ended;
}

}  // namespace flexura
