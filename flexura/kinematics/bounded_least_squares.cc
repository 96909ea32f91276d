#include "flexura/kinematics/bounded_least_squares.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "flexura/math/dense.h"
#include "flexura/math/levenberg_marquardt.h"
#include "flexura/math/small_cholesky.h"

namespace flexura {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

template <int rows>
using Rows = Eigen::Map<const Eigen::Matrix<double, rows, Eigen::Dynamic>>;
template <int rows>
using Column = Eigen::Map<const Eigen::Matrix<double, rows, 1>>;

// Calls `what` with J and r, of a fixed size where problems of that size exist.
template <class What>
auto by_rows(const MatrixXd& J, const VectorXd& r, const What& what) {
  const auto as = [&]<int rows>() {
    return what.template operator()<rows>(Rows<rows>(J.data(), J.rows(), J.cols()),
                                          Column<rows>(r.data(), r.size()));
  };
  if (J.rows() == 3) return as.template operator()<3>();
  if (J.rows() == 5) return as.template operator()<5>();
  if (J.rows() == 6) return as.template operator()<6>();
  return as.template operator()<Eigen::Dynamic>();
}

double square_of(const MatrixXd& J, const VectorXd& r) {
  return by_rows(J, r, []<int rows>(const Rows<rows>&, const Column<rows>& as) { return as.squaredNorm(); });
}

// Returns |r + J way|^2, with the sum in `sum`.
double predict(const MatrixXd& J, const VectorXd& r, const VectorXd& way, VectorXd& sum) {
  return by_rows(J, r, [&]<int rows>(const Rows<rows>& slope, const Column<rows>& here) {
    Eigen::Map<Eigen::Matrix<double, rows, 1>> there(sum.data(), sum.size());
    there.noalias() = here + slope * way;
    return there.squaredNorm();
  });
}

// Computes step = argmin |J step + r|^2 + damping |step|^2, in the smaller of its two forms.
void damped_step(const MatrixXd& all, const VectorXd& residual, double damping, VectorXd& step) {
  by_rows(all, residual, [&]<int rows>(const Rows<rows>& J, const Column<rows>& r) {
    if constexpr (rows != Eigen::Dynamic) {
      Eigen::Matrix<double, rows, rows> A = Eigen::Matrix<double, rows, rows>::Identity() * damping;
      for (Index k = 0; k < J.cols(); ++k) A.noalias() += J.col(k) * J.col(k).transpose();
      const Eigen::Vector<double, rows> y = solve_definite<rows>(A, r);
      for (Index k = 0; k < J.cols(); ++k) step[k] = -J.col(k).dot(y);
    } else if (J.rows() < J.cols()) {
      MatrixXd A = J * J.transpose();
      A.diagonal().array() += damping;
      step.noalias() = -(J.transpose() * Cholesky(A).solve(r));
    } else {
      MatrixXd H = J.transpose() * J;
      H.diagonal().array() += damping;
      step = -Cholesky(H).solve(J.transpose() * r);
    }
  });
}

// Adds bounds that x + step violates to the held bounds. Their variables are moved onto the bound (`offset`)
// and cannot move outward (columns of J). Returns whether any bound was added.
bool hold_broken(const Bounds& bounds, const VectorXd& x, const VectorXd& step, std::vector<char>& is_held,
                 VectorXd& offset, MatrixXd& J) {
  constexpr double slack = 1e-12;
  bool any = false;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (is_held[i] != 0) continue;
    const Bound& bound = bounds[i];
    if (bound.size == 1) {
      const double there = x[bound.at] + step[bound.at];
      const double reach = slack * (bound.high - bound.low);
      if (there <= bound.high + reach && there >= bound.low - reach) continue;
      offset[bound.at] = (there > bound.high ? bound.high : bound.low) - x[bound.at];
      J.col(bound.at).setZero();
    } else {
      const Eigen::Vector2d there = x.segment<2>(bound.at) + step.segment<2>(bound.at);
      const double radius = there.norm();
      if (radius <= bound.high * (1.0 + slack)) continue;
      const Eigen::Vector2d normal = there / radius;
      offset.segment<2>(bound.at) = (bound.high - normal.dot(x.segment<2>(bound.at))) * normal;
      const Eigen::Vector2d tangent(-normal.y(), normal.x());
      for (Index row = 0; row < J.rows(); ++row) {
        auto part = J.row(row).segment<2>(bound.at);
        part = part.dot(tangent) * tangent.transpose();
      }
    }
    is_held[i] = 1;
    any = true;
  }
  return any;
}

void find_gradient(const MatrixXd& J, const VectorXd& r, VectorXd& gradient) {
  by_rows(J, r, [&]<int rows>(const Rows<rows>& slope, const Column<rows>& here) {
    gradient.noalias() = slope.transpose() * here;
  });
}

// H. B. Nielsen (1999): the better the prediction, the lower the damping.
double eased(double damping, double ratio) {
  const double off = 2.0 * ratio - 1.0;
  return std::clamp(damping * std::max(0.2, 1.0 - off * off * off), 1e-6, 1e12);
}

}  // namespace

BoundedDescent::BoundedDescent(BoundedProblem& of, const Bounds& within, Index variables)
    : problem(of),
      bounds(within),
      r(of.row_count()),
      trial_r(of.row_count()),
      J(of.row_count(), variables),
      trial_J(of.row_count(), variables),
      held_J(of.row_count(), variables),
      step(variables),
      offset(variables),
      trial(variables),
      gradient(variables),
      is_held(within.size()) {}

void BoundedDescent::linearise(const VectorXd& x) {
  problem.linearise(x, r, J);
  ++iterations;
  square = square_of(J, r);
  find_gradient(J, r, gradient);
}

void BoundedDescent::try_step(const Bounds& within, const VectorXd& x, double damping) {
  constexpr int max_passes = 6;
  damped_step(J, r, damping, step);
  if (!within.empty()) {
    std::ranges::fill(is_held, 0);
    offset.setZero();
    for (int pass = 0; pass < max_passes; ++pass) {
      if (pass == 0) held_J = J;
      if (!hold_broken(within, x, step, is_held, offset, held_J)) break;
      predict(J, r, offset, trial_r);
      damped_step(held_J, trial_r, damping, step);
      step += offset;
    }
  }
  trial = x + step;
  project(within, trial);
}

Descent BoundedDescent::descend(const DescentLimits& limits, VectorXd& x) {
  problem.linearise(x, r, J);
  ++iterations;
  square = square_of(J, r);
  if (problem.is_met(r)) return Descent::met;
  const auto tried = [&](double damping) -> TriedStep {
    constexpr double least_damping = 1e-14;  // Keeps the factorisation regular for a singular arm.
    // The damping is relative to |r|^2. It vanishes towards a solution, so that the last steps are undamped
    // Gauss-Newton steps.
    try_step(bounds, x, damping * square + least_damping);
    step = trial - x;
    const double predicted_square = predict(J, r, step, trial_r);
    problem.linearise(trial, trial_r, trial_J);
    ++iterations;
    return {square_of(trial_J, trial_r), square - predicted_square};
  };
  const auto is_level = [&] {
    find_gradient(J, r, gradient);
    free_gradient(bounds, x, gradient);
    return gradient.norm() <= limits.slope * std::sqrt(square);
  };
  int slow_steps = 0;
  const auto keep = [&](const TriedStep& kept, double& cost) {
    const bool is_slow = !(kept.cost < 0.99 * cost);
    slow_steps = is_slow ? slow_steps + 1 : 0;
    x.swap(trial), r.swap(trial_r), J.swap(trial_J);
    cost = square = kept.cost;
    return problem.is_met(r) ||
           (is_slow && (is_level() || (limits.most_slow > 0 && slow_steps >= limits.most_slow)));
  };
  const auto leave = [&](const TriedStep&, double) { return is_level(); };
  const Damping damping{.start = 1e-2, .most = 1e15, .rise = 2, .growth = 2, .eased = eased};
  const DescentEnd end = levenberg_marquardt(square, damping, affordable(limits), tried, keep, leave);
  if (problem.is_met(r)) return Descent::met;
  return end == DescentEnd::exhausted ? Descent::exhausted : Descent::stationary;
}

Descent BoundedDescent::descend_gradient(const DescentLimits& limits, VectorXd& x) {
  const auto evaluate = [&](const VectorXd& at) {
    linearise(at);
    return 0.5 * square;
  };
  std::array<double, 8> recent{};
  double value = evaluate(x);
  recent.fill(value);
  double best_value = value;
  VectorXd best = x;
  double length = 1.0 / std::max(1.0, gradient.norm());
  Descent ended = Descent::exhausted;
  for (int i = 0, most = affordable(limits); i < most; ++i) {
    if (problem.is_met(r)) {
      ended = Descent::met;
      break;
    }
    VectorXd& direction = step;
    direction = x - length * gradient;
    project(bounds, direction);
    direction -= x;
    // The fixed points of the projected gradient step are the constrained minima.
    if (direction.norm() <= limits.slope * length * std::sqrt(square)) {
      ended = Descent::stationary;
      break;
    }
    const double slope = gradient.dot(direction);
    const double highest = *std::ranges::max_element(recent);
    offset = gradient;
    double part = 1.0;
    for (int halving = 0; halving < 40; ++halving, part *= 0.5) {
      trial = x + part * direction;
      project(bounds, trial);
      value = evaluate(trial);
      if (value <= highest + 1e-4 * part * slope) break;
    }
    const double moved = (trial - x).squaredNorm();
    const double curvature = (trial - x).dot(gradient - offset);
    length = curvature > 1e-10 * moved ? std::min(moved / curvature, 1e6) : std::min(10 * length, 1e6);
    x.swap(trial);
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
