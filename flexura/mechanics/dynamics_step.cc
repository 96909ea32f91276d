#include <algorithm>
#include <cmath>

#include "flexura/mechanics/dynamics_work.h"

namespace flexura {
namespace {

// An iteration that gains less than this goes nowhere.
constexpr double least_gain = 0.95;
constexpr int patience = 6;

double greatest_change(const Eigen::VectorXd& change, const Eigen::VectorXd& scales) {
  double most = 0;
  for (Eigen::Index j = 0; j < change.size(); ++j) {
    const double size = std::abs(change[j] * scales[j]);
    if (!(size <= most)) most = size;  // Not a number stays.
    if (std::isnan(most)) return most;
  }
  return most;
}

}  // namespace

// The rates at the step's stage, from those of the steps before: a parabola through them.
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

// What is the sum of x_i answers_i along what pulls tight, of a small positive definite matrix: tensions of
// at least 0, by changing one at a time what is slack (principal pivots).
bool RodDynamics::Work::pull_tight() {
  const Eigen::Index count = found_.size();
  const double rounding = 1e-13 * chain.rod().length();
  for (int round = 0; round < 50 + 10 * static_cast<int>(count); ++round) {
    // Cholesky's, of the rows that are taut.
    found_.setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      if (taut_[static_cast<std::size_t>(i)] == 0) continue;
      double right = wanted_[i], diagonal = give_(i, i);
      for (Eigen::Index j = 0; j < i; ++j) {
        if (taut_[static_cast<std::size_t>(j)] == 0) continue;
        double sum = give_(i, j);
        for (Eigen::Index k = 0; k < j; ++k)
          if (taut_[static_cast<std::size_t>(k)] != 0) sum -= pivot_(i, k) * pivot_(j, k);
        pivot_(i, j) = sum / pivot_(j, j);
        diagonal -= pivot_(i, j) * pivot_(i, j);
        right -= pivot_(i, j) * found_[j];
      }
      if (!(diagonal > 0)) return false;
      pivot_(i, i) = std::sqrt(diagonal);
      found_[i] = right / pivot_(i, i);
    }
    for (Eigen::Index i = count; i-- > 0;) {
      if (taut_[static_cast<std::size_t>(i)] == 0) continue;
      found_[i] /= pivot_(i, i);
      for (Eigen::Index k = 0; k < i; ++k)
        if (taut_[static_cast<std::size_t>(k)] != 0) found_[k] -= pivot_(i, k) * found_[i];
    }
    Eigen::Index worst = -1;
    double least = 0;
    for (Eigen::Index i = 0; i < count; ++i)
      if (taut_[static_cast<std::size_t>(i)] != 0 && found_[i] < least) worst = i, least = found_[i];
    if (worst >= 0) {
      taut_[static_cast<std::size_t>(worst)] = 0;
      continue;
    }
    least = -rounding;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (taut_[static_cast<std::size_t>(i)] != 0) continue;
      double left = -wanted_[i];
      for (Eigen::Index j = 0; j < count; ++j) left += give_(i, j) * found_[j];
      if (!std::isfinite(left)) return false;
      if (left < least) worst = i, least = left;
    }
    if (worst < 0) return true;
    taut_[static_cast<std::size_t>(worst)] = 1;
  }
  return false;
}

// change_ is the residual, with the tensions as they are. It becomes the step without tendons; then tensions
// are found with which they are as long as they shall be, and it has those.
bool RodDynamics::Work::solve_with_tendons(const TendonInput& tendons, double stretch) {
  const Eigen::Index count = found_.size();
  for (Eigen::Index i = 0; i < count; ++i) {
    const double tension = tensions[static_cast<std::size_t>(i)];
    if (tension != 0) change_ += stretch * tension * length_slopes_.col(i);
  }
  matrix.solve(change_.data());
  for (Eigen::Index i = 0; i < count; ++i) {
    answers_.col(i) = length_slopes_.col(i);
    matrix.solve(answers_.col(i).data());
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto tendon = static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j < count; ++j)
      give_(i, j) = stretch * stretch * length_slopes_.col(i).dot(answers_.col(j));
    give_(i, i) += compliance[tendon];
    wanted_[i] = lengths_[i] - rest_lengths[tendon] + tendons.displacements[tendon] +
                 stretch * length_slopes_.col(i).dot(change_);
  }
  if (!pull_tight()) return false;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto tendon = static_cast<std::size_t>(i);
    change_ -= stretch * found_[i] * answers_.col(i);
    pull_change_[i] = found_[i] - tensions[tendon];
    tensions[tendon] = found_[i];
  }
  return true;
}

// With x = (q, p): the stage's x = from + stretch dx/dt, in which dq/dt = v and p = M(q) v. What is sought is
// v.
RodStep RodDynamics::Work::step(RodState& state, const TendonInput& tendons, const RodLoads& loads,
                                double h) {
  RodStep result;
  const double stretch = scheme.stage * h;
  const bool by_displacement = !tendons.displacements.empty();
  q_from_ = state.q + scheme.memory * h * state.rate;
  p_from_ = state.momentum + scheme.memory * h * state.force;
  std::fill(tensions.begin(), tensions.end(), 0.0);
  if (by_displacement) {
    std::copy(state.tensions.begin(), state.tensions.end(), tensions.begin());
    for (std::size_t i = 0; i < tensions.size(); ++i) taut_[i] = tensions[i] > 0 ? 1 : 0;
  } else if (!tendons.tensions.empty()) {
    std::copy(tendons.tensions.begin(), tendons.tensions.end(), tensions.begin());
  }
  guess(state, h);
  const Eigen::VectorXd& scales = chain.scales();
  double before = 0, worst_gain = 0;
  // The matrix leaves out how inertia turns with the rod: an iteration gains about the angle of a step's
  // turn.
  double contraction = std::max(state.contraction, stretch * greatest_change(velocity, scales));
  bool is_there = false;
  result.end = DynamicsEnd::did_not_converge;
  while (!is_there) {
    if (result.iterations == config.most_iterations) return result;
    q_ = q_from_ + stretch * velocity;
    motion.place(q_.data(), velocity.data());
    motion.pull(loads, tensions.data(), surroundings);
    motion.balance(momentum_.data(), force_.data());
    if (result.iterations == 0) {
      matrix.find_columns(motion);
      const bool is_pulled = std::ranges::any_of(tensions, [](double tension) { return tension != 0; });
      if (!matrix.factor(motion, {.damping = stretch, .stiffness = stretch * stretch},
                         is_pulled ? tensions.data() : nullptr, surroundings != nullptr))
        return result;
    }
    change_ = p_from_ - momentum_ + stretch * force_;
    if (by_displacement) {
      motion.find_lengths(lengths_.data());
      for (std::size_t i = 0; i < tensions.size(); ++i)
        motion.find_length_slopes(i, length_slopes_.col(static_cast<Eigen::Index>(i)).data());
      if (!solve_with_tendons(tendons, stretch)) return result;
    } else {
      matrix.solve(change_.data());
    }
    ++result.iterations;
    const double size = greatest_change(change_, scales);
    if (!std::isfinite(size)) return result;
    velocity += change_;
    if (before > 0) {
      contraction = size / before;
      worst_gain = std::max(worst_gain, contraction);
      if (result.iterations > patience && contraction > least_gain && size > config.tolerance) return result;
    }
    is_there = size <= config.tolerance || (contraction < 0.5 && 2 * size * contraction <= config.tolerance);
    before = size;
  }
  // The stage's force, with the last change of the rates.
  for (const RodLayout::Section& section : layout.sections) {
    const auto first = static_cast<Eigen::Index>(section.first_mode),
               size = static_cast<Eigen::Index>(section.modes);
    for (Eigen::Index j = 0; j < size; ++j) {
      const std::size_t strain = section.strain[static_cast<std::size_t>(j)];
      double sum = 0;
      for (Eigen::Index l = section.grid.first[strain];
           l < section.grid.first[strain] + section.grid.count[strain]; ++l)
        sum += (section.damping(l, j) + stretch * section.stiffness(l, j)) * change_[first + l];
      force_[first + j] -= sum;
    }
  }
  if (by_displacement)
    for (Eigen::Index i = 0; i < pull_change_.size(); ++i)
      if (pull_change_[i] != 0) force_ -= pull_change_[i] * length_slopes_.col(i);
  if (!force_.allFinite() || !velocity.allFinite()) return result;
  const double now = 1 / scheme.alpha_m, old = (1 - scheme.alpha_m) / scheme.alpha_m;
  state.q += h * (1 - scheme.gamma) * state.rate;
  state.momentum += h * (1 - scheme.gamma) * state.force;
  state.rate = now * velocity - old * state.rate;
  state.force = now * force_ - old * state.force;
  state.q += h * scheme.gamma * state.rate;
  state.momentum += h * scheme.gamma * state.force;
  state.time += h;
  state.tensions = tensions;
  state.middles = state.step == h ? std::min(3, state.middles + 1) : 1;
  state.step = h;
  state.middle[2].swap(state.middle[1]);
  state.middle[1].swap(state.middle[0]);
  state.middle[0] = velocity;
  if (worst_gain > 0) state.contraction = std::min(worst_gain, 0.5);
  result.end = DynamicsEnd::converged;
  return result;
}

}  // namespace flexura
