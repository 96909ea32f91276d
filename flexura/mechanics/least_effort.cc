#include "flexura/mechanics/least_effort.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr int most_steps = 60, most_passes = 10;
// Regularisation: constraint violation per multiplier.
constexpr double give = 1e-11;
constexpr double level = 1e-7;  // Smaller steps count as zero, relative to |x|.
constexpr DescentLimits back{.iterations = 8, .slope = 1e-8};

// Updates the Lagrangian's second derivative by a step and the change of its gradient; it stays positive
// definite.
void update(MatrixXd& H, const VectorXd& step, VectorXd change) {
  const VectorXd known = H * step;
  const double along = step.dot(known), curved = step.dot(change);
  if (!(along > 0)) return;
  if (curved < 0.2 * along) {
    const double part = 0.8 * along / (along - curved);
    change = part * change + (1 - part) * known;
  }
  H += change * change.transpose() / step.dot(change) - known * known.transpose() / along;
}

}  // namespace

VectorXd least_in_box(const MatrixXd& A, const VectorXd& b, const VectorXd& low, const VectorXd& high) {
  const Index count = b.size();
  VectorXd d = VectorXd::Zero(count);
  std::vector<char> is_held(static_cast<std::size_t>(count), 0);
  std::vector<Index> open;
  for (Index i = 0; i < count; ++i) {
    if ((low[i] >= 0 && b[i] >= 0) || (high[i] <= 0 && b[i] <= 0)) is_held[static_cast<std::size_t>(i)] = 1;
  }
  const int most = 20 + 10 * static_cast<int>(count);
  for (int pass = 0; pass < most; ++pass) {
    open.clear();
    for (Index i = 0; i < count; ++i)
      if (is_held[static_cast<std::size_t>(i)] == 0) open.push_back(i);
    VectorXd way = VectorXd::Zero(count);
    if (!open.empty()) {
      const VectorXd slope = A * d + b;
      way(open) = -Cholesky(A(open, open)).solve(slope(open));
    }
    if (!way.allFinite()) return d;
    double part = 1;
    Index stopped = -1;
    for (const Index i : open) {
      const double end = way[i] < 0 ? low[i] : high[i];
      if ((way[i] < 0 ? d[i] + way[i] >= end : d[i] + way[i] <= end) || way[i] == 0) continue;
      const double to = std::max(0.0, (end - d[i]) / way[i]);
      if (to < part) part = to, stopped = i;
    }
    d += part * way;
    if (stopped >= 0) {
      d[stopped] = way[stopped] < 0 ? low[stopped] : high[stopped];
      is_held[static_cast<std::size_t>(stopped)] = 1;
      continue;
    }
    const VectorXd slope = A * d + b;
    Index worst = -1;
    double most_pull = 1e-12 * b.cwiseAbs().maxCoeff();
    for (Index i = 0; i < count; ++i) {
      if (is_held[static_cast<std::size_t>(i)] == 0 || low[i] == high[i]) continue;
      const double pull = d[i] <= low[i] ? -slope[i] : slope[i];
      if (pull > most_pull) worst = i, most_pull = pull;
    }
    if (worst < 0) break;
    is_held[static_cast<std::size_t>(worst)] = 0;
  }
  return d;
}

bool run_down_to_least(BoundedDescent& descent, VectorXd& x) {
  const Index count = x.size();
  VectorXd high(count);
  for (const Bound& bound : descent.bounds) high[bound.at] = bound.high;
  VectorXd r = descent.r, multipliers = VectorXd::Zero(r.size()), candidate;
  MatrixXd J = descent.J, H = MatrixXd::Identity(count, count);
  double part = 1;
  for (int i = 0; i < most_steps; ++i) {
    // Each pass corrects the constraint violation of the regularisation.
    VectorXd step;
    const MatrixXd A = H + J.transpose() * J / give;
    for (int pass = 0; pass < most_passes; ++pass) {
      step = least_in_box(A, x - J.transpose() * (multipliers - r / give), -x, high - x);
      const VectorXd left = J * step + r;
      multipliers -= left / give;
      if (pass > 0 && left.norm() <= 1e-6 * level * x.norm()) break;
    }
    const double size = step.norm(), curved = step.dot(H * step);
    if (size <= level * std::max(x.norm(), 1e-2)) return true;
    candidate = x + part * step;
    project(descent.bounds, candidate);
    const bool is_back = descent.descend(back, candidate) == Descent::met;
    // Rejected steps show the curvature as well.
    const VectorXd moved = candidate - x;
    if (is_back) update(H, moved, moved - (descent.J - J).transpose() * multipliers);
    // Compares Lagrangians, which cancels the effort within the problem's tolerance.
    const double change = 0.5 * (candidate.squaredNorm() - x.squaredNorm()) - multipliers.dot(descent.r - r);
    if (is_back && change <= -1e-4 * part * curved) {
      x = candidate, r = descent.r, J = descent.J;
      part = std::min(1.0, 4 * part);
      continue;
    }
    part *= 0.5;
    if (part < 1e-3) return size <= 1e2 * level * x.norm();
  }
  return false;
}

}  // namespace flexura
