// Steps that do not converge at once: they are repeated in pieces.
#include <algorithm>
#include <utility>
#include <vector>

#include "flexura/mechanics/dynamics_work.h"

namespace flexura {
namespace {

// Number of converged pieces of a step before they become longer again.
constexpr int enough_in_a_row = 4;
// Largest number of pieces tried, converged or not.
constexpr int most_tries = 1000;

}  // namespace

// Long steps leave oscillating momenta in stiff strains, which would be an impact in short steps. Restarts
// from the same shape with the mean rates of the last two steps. Returns whether the old kinetic energy was
// over 1.5 times the new one.
bool RodDynamics::Work::restart(RodState& state, const TendonInput& tendons, const RodLoads& loads) {
  constexpr double most = 1.5;
  const int middles = std::exchange(state.middles, 0);
  if (middles == 0 || !find_velocity(state)) return false;
  const double kinetic = velocity.dot(state.momentum);
  state.rate = middles == 1 ? state.middle[0] : 0.5 * (state.middle[0] + state.middle[1]);
  hold(state.friction.data(), 0);
  motion.place(state.q.data(), state.rate.data());
  set_tensions(tendons);
  motion.pull(loads, tensions.data(), surroundings);
  motion.balance(state.momentum.data(), state.force.data());
  return kinetic > most * state.rate.dot(state.momentum);
}

// Returns the tendons' displacements at the present shape; for slack ones the target displacement.
std::vector<double> RodDynamics::Work::displacements_at(const RodState& state, const TendonInput& tendons) {
  std::vector<double> pulled = tendons.displacements;
  if (pulled.empty()) return pulled;
  velocity.setZero();
  motion.place(state.q.data(), velocity.data());
  motion.find_lengths(lengths_.data());
  for (std::size_t i = 0; i < pulled.size(); ++i) {
    const double taut = rest_lengths[i] - lengths_[static_cast<Eigen::Index>(i)];
    pulled[i] = state.tensions[i] > 0 ? taut + compliance[i] * state.tensions[i] : std::min(pulled[i], taut);
  }
  return pulled;
}

// Repeats the step with full numerical damping in halves of halves, each as long as converges. Tendons are
// pulled in evenly, since all at once would be a harder impact the shorter the first piece is.
bool RodDynamics::Work::step_in_pieces(RodState& state, const TendonInput& tendons, const RodLoads& loads,
                                       double h, RodStep& result) {
  const Scheme damped(0);
  const std::vector<double> pulled = displacements_at(state, tendons);
  TendonInput now = tendons;
  // `left` pieces remain, each 1/parts of the step.
  long parts = 1, left = 1;
  int in_a_row = 0;
  result.pieces = 0;
  result.friction_work = result.friction_loss = 0;
  for (int tries = 0; left > 0; ++tries) {
    const double rest = static_cast<double>(left - 1) / static_cast<double>(parts);
    for (std::size_t i = 0; i < pulled.size(); ++i)
      now.displacements[i] = tendons.displacements[i] + rest * (pulled[i] - tendons.displacements[i]);
    const RodStep piece = step_once(damped, state, now, loads, h / static_cast<double>(parts));
    result.end = piece.end;
    result.iterations += piece.iterations;
    if (!piece.converged()) {
      in_a_row = 0;
      parts *= 2;
      left *= 2;
      if (parts > config.most_pieces || tries > most_tries) return false;
      continue;
    }
    result.friction_work += piece.friction_work;
    result.friction_loss += piece.friction_loss;
    --left;
    ++result.pieces;
    // Tries longer pieces again, since the difficult part may have passed.
    if (++in_a_row < enough_in_a_row || parts == 1 || left % 2 != 0) continue;
    parts /= 2;
    left /= 2;
    in_a_row = 0;
  }
  return true;
}

RodStep RodDynamics::Work::step(RodState& state, const TendonInput& tendons, const RodLoads& loads,
                                double h) {
  RodStep result = step_once(scheme, state, tendons, loads, h);
  if (result.converged() || config.most_pieces < 2) return result;
  result.is_anew = true;
  const RodState before = state;
  RodState begun = state;
  const bool is_swinging = restart(begun, tendons, loads);
  for (const bool anew : {is_swinging, !is_swinging}) {
    state = anew ? begun : before;
    if (!step_in_pieces(state, tendons, loads, h, result)) continue;
    state.time = before.time + h;
    return result;
  }
  state = before;
  result.pieces = 0;
  return result;
}

}  // namespace flexura
