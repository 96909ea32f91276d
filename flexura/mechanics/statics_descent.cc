// Equilibria found by descending the potential energy.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/mechanics/rod_descent.h"
#include "flexura/mechanics/statics.h"

namespace flexura {
namespace {

// Extra compliance of tendons during the descent, relative to the rod's own; its reduction each time the
// tensions still differ from those of the given tendons; and how often.
constexpr double first_penalty = 1e-3, penalty_factor = 0.2;
constexpr int max_penalties = 16;
// Largest change by Newton's method at the end, in radians of a section's bend.
constexpr double nearby = 0.3;
constexpr double unmoved = 1e-6;  // In the same unit.
// Relative change of tensions from one penalty to the next.
constexpr double no_change = 1e-8;

}  // namespace

bool RodStatics::fall(Unknowns& at, Descent& descent) {
  Unknowns there = at;
  bool rests = fall_on(there, descent);
  if (!rests && chain_.has_friction()) {
    // Friction may keep it moving around. The frictionless equilibrium is not far.
    there = at;
    chain_.set_rubbing(false);
    rests = fall_on(there, descent);
    chain_.set_rubbing(true);
    rests = rests && fall_on(there, descent);
  }
  if (rests) at = there;
  return rests;
}

bool RodStatics::fall_on(Unknowns& at, Descent& descent) {
  RodDescent fall(chain_, loads_);
  std::vector<RodDescent::Held> held(pulls_.size());
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (by_displacement_) {
      // Upper bound of tensions of contradicting tendons; above what any shape needs.
      const double most = chain_.rod().length() / give_;
      held[i] = {.tension = std::clamp(at.tensions[static_cast<Eigen::Index>(i)], 0.0, most),
                 .is_held = true,
                 .length = rest_lengths_[i] - input_.displacements[i],
                 .compliance = compliance(i),
                 .penalty = first_penalty * give_};
    } else if (!input_.tensions.empty()) {
      held[i].tension = input_.tensions[i];
    }
  }
  const int before = iterations_;
  for (int i = 0; i < max_penalties; ++i) {
    const bool rests = fall.fall(at.q, held);
    iterations_ = before + fall.iterations();
    if (!rests) return false;
    double change = 0, most = 0;  // Of tensions, N.
    for (std::size_t t = 0; t < held.size() && by_displacement_; ++t) {
      double& tension = at.tensions[static_cast<Eigen::Index>(t)];
      change = std::max(change, std::abs(held[t].tension - tension));
      most = std::max(most, held[t].tension);
      tension = held[t].tension;
      taut_[t] = tension > 0 ? 1 : 0;
      held[t].penalty *= penalty_factor;
    }
    Unknowns there = at;
    descent = descend(there, 1);
    const double moved = measure({there.q - at.q, {}});
    if (descent.settled && has_positive_stretch() && moved <= (descent.negative == 0 ? nearby : unmoved)) {
      // Equilibria held by tendons that are just taut are stable, too.
      descent.negative = 0;
      at = there;
      return true;
    }
    // Newton's method does not converge with friction or nearly without stiffness in a direction.
    if (change <= no_change * most) {
      (void)linearize(at, 1);
      descent = {.settled = true, .negative = 0};
      return true;
    }
    if (!by_displacement_) return false;
  }
  return false;
}

Equilibrium RodStatics::settle(const TendonInput& tendons, const RodLoads& loads) {
  return settle(tendons, loads, {});
}

Equilibrium RodStatics::settle(const TendonInput& tendons, const RodLoads& loads, const Equilibrium& near) {
  Equilibrium result;
  Unknowns at;
  if (const std::string problem = take(tendons, loads); problem.empty() && is_start(near)) {
    iterations_ = 0;
    at = start_at(near);
    Descent descent = descend(at, 1);
    bool found = descent.settled && descent.always_stable && has_positive_stretch();
    if (!found) {
      at = start_at(near);
      found = fall(at, descent);
      result.ambiguous = found;
    }
    if (found) {
      finish(result, at, descent);
      return result;
    }
  }
  result = solve(tendons, loads, near);
  if (!result.converged() || result.stable) return result;
  // Descends from a shape that is not in equilibrium.
  Descent descent;
  at = start_at(result);
  if (!fall(at, descent)) return solve(tendons, loads, near);
  Equilibrium fallen;
  const bool has_moved = measure({at.q - result.q, {}}) > unmoved;
  fallen.snapped = result.snapped || has_moved;
  fallen.ambiguous = result.ambiguous || has_moved;
  finish(fallen, at, descent);
  return fallen;
}

}  // namespace flexura
