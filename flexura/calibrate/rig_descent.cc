#include "flexura/calibrate/rig_descent.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "flexura/math/dense.h"
#include "flexura/math/median.h"

namespace flexura {
namespace {

// Where residuals begin to count linearly: far from the answer most are large, and have to draw.
double bound_of(const RigProblem& problem, const RigDescentConfig& config) {
  if (!config.does_bound_rise) return config.bound;
  constexpr double spread = 2;
  std::vector<double> sizes = problem.sizes();
  if (sizes.empty()) return config.bound;
  return std::max(config.bound, spread * median(std::span(sizes)));
}

void hold(const std::vector<bool>& is_free, Eigen::VectorXd& gradient, Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    if (is_free.empty() || is_free[static_cast<std::size_t>(i)]) continue;
    gradient[i] = 0;
    matrix.row(i).setZero(), matrix.col(i).setZero(), matrix(i, i) = 1;
  }
}

class Descent {
 public:
  Descent(RigProblem& problem, const RigDescentConfig& config) : problem_(problem), config_(config) {}

  RigDescent run(const Eigen::VectorXd& start) {
    RigDescent result{.x = start, .cost = std::numeric_limits<double>::infinity()};
    if (!problem_.linearise(start)) return result;
    while (result.iterations < config_.most_iterations && !result.is_settled) {
      ++result.iterations;
      result.is_settled = step(result.x);
    }
    (void)problem_.linearise(result.x);
    result.is_settled = result.is_settled || is_at_the_bottom();
    result.cost = problem_.cost(config_.bound);
    return result;
  }

 private:
  // Moves x down, if it can. Whether there is nowhere left to go.
  bool step(Eigen::VectorXd& x) {
    constexpr double small = 1e-14, most_damping = 1e12, least_damping = 1e-12;
    const double bound = bound_of(problem_, config_), before = problem_.cost(bound);
    problem_.normal(bound, gradient_, normal_);
    hold(config_.is_free, gradient_, normal_);
    for (; damping_ < most_damping; damping_ *= 5) {
      damped_ = normal_;
      damped_.diagonal() += damping_ * normal_.diagonal().cwiseMax(std::numeric_limits<double>::min());
      if (!factors_.compute(damped_)) continue;
      move_ = -gradient_;
      factors_.solve_in_place(move_);
      const double promised = -0.5 * gradient_.dot(move_);
      if (!(promised > small * before)) return true;
      there_ = x + move_;
      if (!problem_.linearise(there_) || !(problem_.cost(bound) < before)) continue;
      x = there_;
      damping_ = std::max(damping_ / 10, least_damping);
      return false;
    }
    return true;
  }

  // Whether a whole step would lower the cost by less than a thousandth of a standard deviation of anything
  // does.
  bool is_at_the_bottom() {
    constexpr double nothing = 1e-6;
    problem_.normal(bound_of(problem_, config_), gradient_, normal_);
    hold(config_.is_free, gradient_, normal_);
    if (!factors_.compute(normal_)) return false;
    move_ = gradient_;
    factors_.solve_in_place(move_);
    return 0.5 * gradient_.dot(move_) < nothing;
  }

  RigProblem& problem_;
  const RigDescentConfig& config_;
  double damping_ = 1e-4;
  Eigen::VectorXd gradient_, move_, there_;
  Eigen::MatrixXd normal_, damped_;
  Cholesky factors_;
};

}  // namespace

RigDescent descend(RigProblem& problem, const Eigen::VectorXd& start, const RigDescentConfig& config) {
  // A camera at the height of a rim sees now this half of it, now that one; were they changed within a
  // descent, its steps would be torn to and fro. Where they still change in the end it stands at that very
  // height.
  constexpr int most_rounds = 3;
  RigDescent result{.x = start};
  int iterations = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const bool is_changed = problem.choose_rims(result.x);
    if (round > 0 && !is_changed) break;
    result = Descent(problem, config).run(result.x);
    iterations += result.iterations;
  }
  result.iterations = iterations;
  return result;
}

}  // namespace flexura
