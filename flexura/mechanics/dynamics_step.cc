#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "flexura/mechanics/dynamics_work.h"

namespace flexura {
namespace {

// An iteration whose error shrinks less than by this factor counts as diverging.
constexpr double least_gain = 0.95;
// With surroundings, an iteration with less gain than this gets a new matrix.
constexpr double slow_gain = 0.2;
// The exact derivative with friction costs as much as some thirty iterations.
constexpr double slow_friction_gain = 0.75;
constexpr int patience = 6;

double greatest_change(const Eigen::VectorXd& change, const Eigen::VectorXd& scales) {
  double most = 0;
  for (Eigen::Index j = 0; j < change.size(); ++j) {
    const double size = std::abs(change[j] * scales[j]);
    if (!(size <= most)) most = size;  // Keeps NaN.
    if (std::isnan(most)) return most;
  }
  return most;
}

// Steps of an iteration with an approximate derivative, corrected by what earlier steps achieved: the good
// method of C. G. Broyden (1965).
class LearningSteps {
 public:
  explicit LearningSteps(const Eigen::VectorXd& scales) : squares_(scales.cwiseAbs2()) {}

  void clear() { corrections_.clear(); }
  // Returns the corrected step from the one by the approximate derivative.
  [[nodiscard]] Eigen::VectorXd corrected(Eigen::VectorXd step) const {
    for (const Correction& each : corrections_) step += product(each.step, step) * each.by_step;
    return step;
  }
  // Learns from a step that was made in full. `left`: the step by the approximate derivative at its end.
  void learn(const Eigen::VectorXd& step, const Eigen::VectorXd& left) {
    constexpr double least = 0.1;  // Limits how much a step becomes longer.
    Eigen::VectorXd after = corrected(left);
    const double square = product(step, step), along = product(step, after);
    if (!std::isfinite(along) || !(square > 0)) return;
    after /= std::max(least * square, square - along);
    corrections_.push_back({step, std::move(after)});
  }

 private:
  // With the scaled product of `step` and a step, `by_step` times it is added.
  struct Correction {
    Eigen::VectorXd step, by_step;
  };
  [[nodiscard]] double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return (a.array() * b.array() * squares_.array()).sum();
  }
  Eigen::VectorXd squares_;
  std::vector<Correction> corrections_;
};

}  // namespace

// Extrapolates the rates at the step's stage from those of the last steps by a parabola.
void RodDynamics::Work::guess(const RodState& state, double h) {
  const bool is_same = state.step == h;
  if (is_same && state.middles >= 3) {
    velocity = 3 * (state.middle[0] - state.middle[1]) + state.middle[2];
  } else if (is_same && state.middles == 2) {
    velocity = 2 * state.middle[0] - state.middle[1];
  } else if (state.middles >= 1) {
    velocity = state.middle[0];
  } else {
    velocity = state.rate;
  }
}

// Returns the size of the change of the rates, rad/s: the rate of the rod turned as a whole with the same
// energy in the quadratic form of the stage's equations, stiffness included.
double RodDynamics::Work::change_size() const {
  const double size = std::sqrt(std::abs(change_.dot(left_)) / turning_inertia_);
  if (!rubs()) return size;
  // Friction has no energy, and both vectors may be orthogonal where it holds.
  constexpr double part = 1e-3;
  return std::max(size, part * greatest_change(change_, chain.scales()));
}

void RodDynamics::Work::evaluate(const Stage& stage) {
  q_ = q_from_ + stage.stretch * velocity;
  motion.place(q_.data(), velocity.data());
  motion.pull(stage.loads, tensions.data(), surroundings);
  motion.balance(momentum_.data(), force_.data());
  change_ = p_from_ - momentum_ + stage.stretch * force_;
  if (!stage.by_displacement()) return;
  motion.find_lengths(lengths_.data());
  for (std::size_t i = 0; i < tensions.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    motion.find_length_slopes(i, length_slopes_.col(column).data());
    if (rubs()) motion.find_pull_slopes(i, tensions[i], pull_slopes_.col(column).data());
  }
}

void RodDynamics::Work::begin(const RodState& state, const Stage& stage, double h) {
  std::ranges::fill(tensions, 0.0);
  if (stage.by_displacement()) {
    std::ranges::copy(state.tensions, tensions.begin());
    for (std::size_t i = 0; i < tensions.size(); ++i) taut_[i] = tensions[i] > 0 ? 1 : 0;
  } else if (!stage.tendons.tensions.empty()) {
    std::ranges::copy(stage.tendons.tensions, tensions.begin());
  }
  guess(state, h);
}

// Iterates with the matrix of the stage's first shape, which neglects the rotation of inertia and loads with
// the rod.
bool RodDynamics::Work::iterate_quickly(const Stage& stage, double contraction, RodStep& result,
                                        double& worst_gain) {
  double before = 0;
  bool is_stale = true;
  while (result.iterations < config.most_iterations) {
    evaluate(stage);
    if (is_stale) {
      matrix.find_columns(motion);
      const bool is_pulled = std::ranges::any_of(tensions, [](double tension) { return tension != 0; });
      if (!matrix.factor(motion, {.damping = stage.stretch, .stiffness = stage.stretch * stage.stretch},
                         is_pulled ? tensions.data() : nullptr, surroundings != nullptr))
        return false;
      is_stale = false;
    }
    if (!solve_quickly(stage)) return false;
    ++result.iterations;
    const double size = change_size();
    if (!std::isfinite(size)) return false;
    velocity += change_;
    if (before > 0) {
      contraction = size / before;
      worst_gain = std::max(worst_gain, contraction);
      // Contact changes as the rod moves.
      is_stale = surroundings != nullptr && contraction > slow_gain;
      if (result.iterations > patience && contraction > least_gain && size > config.tolerance) return false;
    }
    if (size <= config.tolerance || (contraction < 0.5 && 2 * size * contraction <= config.tolerance))
      return true;
    before = size;
  }
  return false;
}

bool RodDynamics::Work::factor_exactly(const Stage& stage) {
  Eigen::MatrixXd momentum, force;
  differentiate(q_, velocity, stage.loads, stage.stretch, 1, momentum, force);
  momentum -= stage.stretch * force;
  if (!momentum.allFinite()) return false;
  factor_ = std::make_shared<const RodStepFactor>(
      RodStepFactor{.stretch = stage.stretch, .lu = Eigen::PartialPivLU<Eigen::MatrixXd>(momentum)});
  return true;
}

// Newton's method with the exact derivative. Each step is damped to shorten the next one (P. Deuflhard's
// natural monotonicity test). It starts with the derivative of an earlier step, if there is one, and keeps a
// derivative, corrected by what it learns, while iterations converge fast.
bool RodDynamics::Work::iterate_exactly(const Stage& stage, RodStep& result) {
  constexpr double similar = 0.8;
  bool is_old =
      factor_ && similar * factor_->stretch <= stage.stretch && similar * stage.stretch <= factor_->stretch;
  evaluate(stage);
  if (!change_.allFinite() || (!is_old && !factor_exactly(stage)) || !solve_exactly(stage)) return false;
  const int most = result.iterations + config.most_iterations;
  LearningSteps learned(chain.scales());
  Eigen::VectorXd step = change_, from = velocity;
  double size = greatest_change(step, chain.scales());
  while (result.iterations < most && std::isfinite(size)) {
    double part = 1, next = std::numeric_limits<double>::infinity();
    for (; part > 1e-4; part /= 2) {
      velocity = from + part * step;
      evaluate(stage);
      ++result.iterations;
      if (change_.allFinite() && solve_exactly(stage)) {
        next = greatest_change(change_, chain.scales());
        if (next <= (1 - part / 4) * size || change_size() <= config.tolerance) break;
      }
      if (is_old) break;
    }
    if (change_.allFinite() && change_size() <= config.tolerance) {
      matrix.find_columns(motion);
      velocity += change_;
      return true;
    }
    if (rubs() && part == 1 && next < slow_friction_gain * size) {
      // If friction iterations converge, the old derivative is good enough.
      learned.learn(step, change_);
      from = velocity;
      step = learned.corrected(change_);
      size = next;
      continue;
    }
    learned.clear();
    if (is_old)
      velocity = from;
    else if (!(part > 1e-4) || !std::isfinite(next))
      return false;
    is_old = false;
    from = velocity;
    evaluate(stage);
    if (!factor_exactly(stage) || !solve_exactly(stage)) return false;
    step = change_;
    size = greatest_change(step, chain.scales());
  }
  return false;
}

// Updates the stage's force by the last change of the rates.
void RodDynamics::Work::finish_force(const Stage& stage) {
  if (rubs()) {
    evaluate(stage);
    return;
  }
  if (surroundings != nullptr && (motion.is_coupled() || !matrix.has_columns_of(motion))) {
    evaluate(stage);
    return;
  }
  for (const RodLayout::Section& section : layout.sections) {
    const auto first = static_cast<Eigen::Index>(section.first_mode),
               size = static_cast<Eigen::Index>(section.modes);
    for (Eigen::Index j = 0; j < size; ++j) {
      const std::size_t strain = section.strain[static_cast<std::size_t>(j)];
      const Eigen::Index begin = section.grid.first[strain], end = begin + section.grid.count[strain];
      double sum = 0;
      for (Eigen::Index l = begin; l < end; ++l)
        sum += (section.damping(l, j) + stage.stretch * section.stiffness(l, j)) * change_[first + l];
      force_[first + j] -= sum;
    }
  }
  for (Eigen::Index i = 0; stage.by_displacement() && i < pull_change_.size(); ++i)
    if (pull_change_[i] != 0) force_ -= pull_change_[i] * length_slopes_.col(i);
  if (surroundings != nullptr) matrix.add_pull_change(motion, stage.stretch, change_.data(), force_.data());
}

// Computes the step's end from the stage.
bool RodDynamics::Work::finish(const Stage& stage, RodState& state, double h, RodStep& result) {
  finish_force(stage);
  if (!force_.allFinite() || !velocity.allFinite()) return false;
  const Scheme& use = stage.scheme;
  const double now = 1 / use.alpha_m, old = (1 - use.alpha_m) / use.alpha_m;
  left_ =
      state.momentum + h * ((1 - use.gamma) * state.force + use.gamma * (now * force_ - old * state.force));
  change_ = state.q + h * ((1 - use.gamma) * state.rate + use.gamma * (now * velocity - old * state.rate));
  if (!is_of_this_world(left_) || !is_of_this_world(change_)) return false;
  if (rubs() && !add_friction_work(state, h, result)) return false;
  state.q += h * (1 - use.gamma) * state.rate;
  state.momentum += h * (1 - use.gamma) * state.force;
  state.rate = now * velocity - old * state.rate;
  state.force = now * force_ - old * state.force;
  state.q += h * use.gamma * state.rate;
  state.momentum += h * use.gamma * state.force;
  state.time += h;
  std::ranges::copy(tensions, state.tensions.begin());
  if (rubs()) std::ranges::copy(motion.frictions(), state.friction.begin());
  state.middles = state.step == h ? std::min(3, state.middles + 1) : 1;
  state.step = h;
  state.middle[2].swap(state.middle[1]);
  state.middle[1].swap(state.middle[0]);
  state.middle[0] = velocity;
  return true;
}

// With x = (q, p), the stage is x = from + stretch dx/dt, in which dq/dt = v and p = M(q) v. The unknown is
// v.
RodStep RodDynamics::Work::step_once(const Scheme& use, RodState& state, const TendonInput& tendons,
                                     const RodLoads& loads, double h) {
  const Stage stage{.scheme = use, .tendons = tendons, .loads = loads, .stretch = use.stage * h};
  RodStep result{.end = DynamicsEnd::did_not_converge};
  q_from_ = state.q + use.memory * h * state.rate;
  p_from_ = state.momentum + use.memory * h * state.force;
  begin(state, stage, h);
  double worst_gain = 0;
  if (rubs()) {
    // The quick matrix does not include friction.
    hold(state.friction.data(), h);
    factor_ = state.factor;
    if (!iterate_exactly(stage, result)) {
      begin(state, stage, h);
      velocity.setZero();
      factor_.reset();
      if (!iterate_exactly(stage, result)) return result;
    }
    state.factor = factor_;
  } else {
    const double turn = stage.stretch * greatest_change(velocity, chain.scales());
    if (!iterate_quickly(stage, std::max(state.contraction, turn), result, worst_gain)) {
      begin(state, stage, h);
      velocity.setZero();
      factor_.reset();
      if (!iterate_exactly(stage, result)) return result;
    }
  }
  if (!finish(stage, state, h, result)) return result;
  if (worst_gain > 0) state.contraction = std::min(worst_gain, 0.5);
  result.end = DynamicsEnd::converged;
  return result;
}

// Adds from the stage the friction work of the step and its dissipated part (not stored in the bristles).
// Returns false if they are not finite.
bool RodDynamics::Work::add_friction_work(const RodState& state, double h, RodStep& result) const {
  double total = 0, loss = 0;
  for (std::size_t i = 0; i < layout.pieces; ++i) {
    const double held = motion.frictions()[i], before = state.friction[i];
    if (grip[i] == 0) continue;
    const double work = held * h * motion.slides()[i];
    total += work;
    loss += work - (held - before) * (held + before) / (2 * grip[i]);
  }
  if (!std::isfinite(total) || !std::isfinite(loss)) return false;
  result.friction_work += total;
  result.friction_loss += loss;
  return true;
}

}  // namespace flexura
