#include "flexura/calibrate/rig_descent.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "flexura/math/dense.h"
#include "flexura/math/levenberg_marquardt.h"
#include "flexura/math/median.h"

namespace flexura {
namespace {

// Bound beyond which residuals count linearly. Far from the minimum most residuals are large and must keep
// their pull.
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

class RigSteps {
 public:
  RigSteps(RigProblem& problem, const RigDescentConfig& config, const Eigen::VectorXd& start)
      : problem_(problem),
        config_(config),
        result_{.x = start, .cost = std::numeric_limits<double>::infinity()} {}

  RigDescent run() {
    if (!problem_.linearise(result_.x)) return result_;
    const auto eased = [](double damping, double) { return std::max(damping / 10, 1e-12); };
    const auto try_step = [this](double damping) { return tried(damping); };
    const auto keep = [this](const TriedStep&, double& cost) {
      result_.x.swap(there_);
      cost = prepare();
      return ++result_.iterations >= config_.most_iterations;
    };
    const auto leave = [this](const TriedStep& step, double) { return !is_worth_it(step.promised); };
    levenberg_marquardt(prepare(), {.rise = 5, .eased = eased}, std::numeric_limits<int>::max(), try_step,
                        keep, leave);
    (void)problem_.linearise(result_.x);
    // If iterations are left, the last one found no descent.
    result_.is_settled = result_.iterations < config_.most_iterations || is_at_the_bottom();
    result_.iterations = std::min(result_.iterations + 1, config_.most_iterations);
    result_.cost = problem_.cost(config_.bound);
    return result_;
  }

 private:
  TriedStep tried(double damping) {
    damped_ = normal_;
    damped_.diagonal() += damping * normal_.diagonal().cwiseMax(std::numeric_limits<double>::min());
    if (!factors_.compute(damped_)) return {};
    move_ = -gradient_;
    factors_.solve_in_place(move_);
    const double promised = -0.5 * gradient_.dot(move_);
    there_ = result_.x + move_;
    if (!is_worth_it(promised) || !problem_.linearise(there_)) return {.promised = promised};
    return {problem_.cost(bound_), promised};
  }
  // Computes the normal equations at the present point; returns the cost there.
  double prepare() {
    bound_ = bound_of(problem_, config_);
    problem_.normal(bound_, gradient_, normal_);
    hold(config_.is_free, gradient_, normal_);
    return cost_ = problem_.cost(bound_);
  }
  [[nodiscard]] bool is_worth_it(double promised) const { return promised > 1e-14 * cost_; }
  // Whether a full step would lower the cost by less than a thousandth of a standard deviation of any
  // variable does.
  bool is_at_the_bottom() {
    constexpr double nothing = 1e-6;
    if (!factors_.compute(normal_)) return false;
    move_ = gradient_;
    factors_.solve_in_place(move_);
    return 0.5 * gradient_.dot(move_) < nothing;
  }

  RigProblem& problem_;
  const RigDescentConfig& config_;
  RigDescent result_;
  double bound_ = 0, cost_ = 0;
  Eigen::VectorXd gradient_, move_, there_;
  Eigen::MatrixXd normal_, damped_;
  Cholesky factors_;
};

}  // namespace

RigDescent descend(RigProblem& problem, const Eigen::VectorXd& start, const RigDescentConfig& config) {
  // For a camera at the height of a rim, the visible half of it may alternate. The halves are therefore fixed
  // during a descent. If they still change at the end, the camera is at that very height.
  constexpr int most_rounds = 3;
  RigDescent result{.x = start};
  int iterations = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const bool is_changed = problem.choose_rims(result.x);
    if (round > 0 && !is_changed) break;
    result = RigSteps(problem, config, result.x).run();
    iterations += result.iterations;
  }
  result.iterations = iterations;
  return result;
}

}  // namespace flexura
