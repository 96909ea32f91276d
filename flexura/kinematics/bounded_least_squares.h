#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "flexura/kinematics/bounds.h"
#include "flexura/math/dense.h"
#include "flexura/math/small_cholesky.h"

// Levenberg-Marquardt within bounds, for few residuals of possibly many variables. A Problem has
//   static constexpr int rows (or Eigen::Dynamic), row_count(), types Residual and Jacobian,
//   linearise(x, r, J), and is_met(r): nothing more is asked for.
//
// Bounds are held by projection and an active set, not by a smooth change of variables: solutions at a limit
// are common (a tentacle reaches far corners with its sections fully bent), and there a change of variables
// has a derivative of zero, crawls, and cannot tell which limit holds it.
namespace flexura {

/// How a descent ended.
enum class Descent {
  met,         ///< The problem is met.
  stationary,  ///< No free direction leads down from here: a minimum within the bounds.
  exhausted,   ///< Out of iterations.
};

/// The memory of a descent, for one problem's size: iterations allocate nothing when `rows` is fixed.
template <class Problem>
struct DescentMemory {
  using Residual = typename Problem::Residual;
  using Jacobian = typename Problem::Jacobian;

  DescentMemory(const Problem& problem, Eigen::Index variables, std::size_t bound_count)
      : r(problem.row_count()),
        trial_r(problem.row_count()),
        J(problem.row_count(), variables),
        trial_J(problem.row_count(), variables),
        held_J(problem.row_count(), variables),
        step(variables),
        offset(variables),
        trial(variables),
        gradient(variables),
        is_held(bound_count) {}

  Residual r, trial_r;
  Jacobian J, trial_J, held_J;
  Eigen::VectorXd step, offset, trial, gradient;
  std::vector<char> is_held;
  int iterations = 0;  ///< Linearisations so far, over all descents.
};

/// step = argmin |J step + r|^2 + damping |step|^2, in the smaller of its two forms.
template <class Jacobian, class Residual>
void damped_step(const Jacobian& J, const Residual& r, double damping, Eigen::VectorXd& step) {
  constexpr int rows = Jacobian::RowsAtCompileTime;
  if constexpr (rows != Eigen::Dynamic) {
    Eigen::Matrix<double, rows, rows> A = Eigen::Matrix<double, rows, rows>::Identity() * damping;
    for (Eigen::Index k = 0; k < J.cols(); ++k) A.noalias() += J.col(k) * J.col(k).transpose();
    const Eigen::Vector<double, rows> y = solve_definite<rows>(A, r);
    for (Eigen::Index k = 0; k < J.cols(); ++k) step[k] = -J.col(k).dot(y);
  } else if (J.rows() < J.cols()) {
    Eigen::MatrixXd A = J * J.transpose();
    A.diagonal().array() += damping;
    step.noalias() = -(J.transpose() * Cholesky(A).solve(r));
  } else {
    Eigen::MatrixXd H = J.transpose() * J;
    H.diagonal().array() += damping;
    step = -Cholesky(H).solve(J.transpose() * r);
  }
}

/// Adds to the held bounds those that x + step breaks: their variables go onto the bound (`offset`) and lose
/// the direction out of it (columns of J). Whether there were any.
template <class Jacobian>
bool hold_broken(const Bounds& bounds, const Eigen::VectorXd& x, const Eigen::VectorXd& step,
                 std::vector<char>& is_held, Eigen::VectorXd& offset, Jacobian& J) {
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
      auto columns = J.template middleCols<2>(bound.at);
      const Eigen::Vector2d tangent(-normal.y(), normal.x());
      columns = ((columns * tangent) * tangent.transpose()).eval();
    }
    is_held[i] = 1;
    any = true;
  }
  return any;
}

/// memory.trial = x plus the damped step that keeps to the bounds: what the bounds stop is stopped, and the
/// other variables make up for it, until nothing more is stopped.
template <class Problem>
void bounded_step(const Bounds& bounds, const Eigen::VectorXd& x, double damping,
                  DescentMemory<Problem>& memory) {
  constexpr int max_passes = 6;
  damped_step(memory.J, memory.r, damping, memory.step);
  if (!bounds.empty()) {
    std::ranges::fill(memory.is_held, 0);
    memory.offset.setZero();
    bool first = true;
    for (int pass = 0; pass < max_passes; ++pass) {
      if (first) memory.held_J = memory.J;
      first = false;
      if (!hold_broken(bounds, x, memory.step, memory.is_held, memory.offset, memory.held_J)) break;
      memory.trial_r.noalias() = memory.r + memory.J * memory.offset;
      damped_step(memory.held_J, memory.trial_r, damping, memory.step);
      memory.step += memory.offset;
    }
  }
  memory.trial = x + memory.step;
  project(bounds, memory.trial);
}

/// What ends a descent before the problem is met.
struct DescentLimits {
  int iterations = 60;
  double slope = 1e-4;  ///< Stationary when |free gradient| <= slope |r|.
};

/// Descends from x, which is within `bounds` and stays there, by damped Gauss-Newton steps. memory.r and .J
/// are those of x afterwards.
template <class Problem>
Descent descend(Problem& problem, const Bounds& bounds, const DescentLimits& limits, Eigen::VectorXd& x,
                DescentMemory<Problem>& memory) {
  problem.linearise(x, memory.r, memory.J);
  ++memory.iterations;
  double square = memory.r.squaredNorm();
  double damping = 1e-2;  // Of |r|^2: vanishes towards a solution, so that the last steps are Newton's.
  double growth = 2.0;
  for (int i = 0; i < limits.iterations; ++i) {
    if (problem.is_met(memory.r)) return Descent::met;
    constexpr double least_damping = 1e-14;  // Keeps the factorisation of a singular arm sound.
    bounded_step(bounds, x, damping * square + least_damping, memory);
    // What the linear model promises of |r|^2.
    memory.trial_r.noalias() = memory.r + memory.J * (memory.trial - x);
    const double promised = square - memory.trial_r.squaredNorm();
    problem.linearise(memory.trial, memory.trial_r, memory.trial_J);
    ++memory.iterations;
    const double trial_square = memory.trial_r.squaredNorm();
    const double gain = promised > 0.0 ? (square - trial_square) / promised : -1.0;
    const bool is_slow = !(trial_square < 0.99 * square);
    if (trial_square < square) {
      x.swap(memory.trial);
      std::swap(memory.r, memory.trial_r);
      memory.J.swap(memory.trial_J);
      square = trial_square;
      const double ease = 2.0 * gain - 1.0;
      damping = std::clamp(damping * std::max(0.2, 1.0 - ease * ease * ease), 1e-6, 1e12);
      growth = 2.0;
    } else {
      damping *= growth;
      growth *= 2.0;
      if (damping > 1e15) return Descent::stationary;
    }
    if (is_slow) {
      memory.gradient.noalias() = memory.J.transpose() * memory.r;
      free_gradient(bounds, x, memory.gradient);
      if (memory.gradient.norm() <= limits.slope * std::sqrt(square)) return Descent::stationary;
    }
  }
  return problem.is_met(memory.r) ? Descent::met : Descent::exhausted;
}

}  // namespace flexura
