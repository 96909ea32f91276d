#include "flexura/sim/static_plant.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

// Maximum number of field turns lost in one step; the loss continues in the next step.
constexpr int most_turns = 50;

}  // namespace

StaticPlant::StaticPlant(const PlantSetup& setup)
    : RodPlant(setup), horizon_(setup.horizon), statics_(inputs().rod()) {
  snapshots_.push_back(settled(0, {0, {}, inputs().nothing_lost(), false}));
}

void StaticPlant::forget() {
  const std::lock_guard lock(mutex_);
  answer_.reset();
}

void StaticPlant::advance(double time) {
  const long last = static_cast<long>(std::floor(time / step));
  for (long next = snapshots_.back().index + 1; next <= last; ++next) {
    Snapshot then = settled(next, snapshots_.back());
    then.has_jumped = is_jump(snapshots_.back(), then);
    snapshots_.push_back(std::move(then));
  }
  const double oldest = time - horizon_ - 2 * step;
  std::size_t gone = 0;
  while (gone + 1 < snapshots_.size() && static_cast<double>(snapshots_[gone + 1].index) * step < oldest)
    ++gone;
  snapshots_.erase(snapshots_.begin(), snapshots_.begin() + static_cast<std::ptrdiff_t>(gone));
  inputs().forget_before(oldest);
  forget();
}

// Returns the snapshot at a later step that follows from `from`.
StaticPlant::Snapshot StaticPlant::settled(long index, Snapshot from) const {
  const double then = static_cast<double>(index) * step;
  from.index = index;
  from.at = solved(then, from.at, from.lost);
  // Each lost turn of a motor's field lets its tendon out, and other tendons take over its load.
  for (int turn = 0; turn < most_turns && inputs().lose_steps(then, from.at.tensions, from.lost); ++turn)
    from.at = solved(then, from.at, from.lost);
  return from;
}

const StaticPlant::Snapshot& StaticPlant::snapshot(double time) const {
  std::size_t from = snapshots_.size() - 1;
  while (from > 0 && static_cast<double>(snapshots_[from].index) * step > time) --from;
  return snapshots_[from];
}

Equilibrium StaticPlant::equilibrium(double time) const {
  {
    const std::lock_guard lock(mutex_);
    if (answer_ && answer_->time == time) return answer_->at;
  }
  const Snapshot& from = snapshot(time);
  Equilibrium at = solved(time, from.at, from.lost);
  const std::lock_guard lock(mutex_);
  answer_ = {time, at};
  return at;
}

// Returns whether the tip moved much farther than the tendon displacements in that time can explain.
bool StaticPlant::is_jump(const Snapshot& from, const Snapshot& to) const {
  // Fraction of the arm's length; multiple of the tip motion of an evenly bent arm.
  constexpr double least = 0.1, many = 2;
  const double length = inputs().rod().length();
  const double way = (to.at.tip.position - from.at.tip.position).norm();
  if (way < least * length) return false;
  const double start = static_cast<double>(from.index) * step, end = static_cast<double>(to.index) * step;
  if (inputs().is_weighed_anew(start, end) || inputs().is_pushed_anew(start, end)) return false;
  const std::vector<double> before = inputs().displacements(start, from.lost),
                            after = inputs().displacements(end, to.lost);
  double bent = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    bent += std::abs(after[i] - before[i]) / inputs().rod().tendons[i].at(0).value.norm();
  return way > many * bent * length;
}

std::string StaticPlant::warning(double time) const {
  constexpr double lasts = 0.2;  // s
  const Equilibrium at = equilibrium(time);
  const bool has_jumped = std::ranges::any_of(snapshots_, [time](const Snapshot& each) {
    const double then = static_cast<double>(each.index) * step;
    return each.has_jumped && then <= time && time < then + lasts;
  });
  if (at.snapped || has_jumped)
    return "the arm snaps: there is no stable equilibrium nearby, and the arm jumps to another equilibrium";
  if (!at.stable)
    return "the equilibrium of the arm is unstable: a small push makes the arm leave the equilibrium";
  return {};
}

// Nodes in addition to the integration points change nothing else.
void StaticPlant::grab(const std::optional<RodPlace>& place) const {
  if (place == grabbed_) return;
  statics_ = place ? RodStatics(inputs().rod(), std::array{*place}) : RodStatics(inputs().rod());
  grabbed_ = place;
}

Equilibrium StaticPlant::solved(double time, const Equilibrium& near, const std::vector<double>& lost) const {
  const TendonInput input{.displacements = inputs().displacements(time, lost)};
  RodLoads loads = inputs().loads(time);
  std::optional<RodPlace> place;
  if (const auto spring = inputs().spring(time)) {
    loads.springs = {*spring};
    place = RodPlace{spring->section, spring->at};
  }
  const std::lock_guard lock(mutex_);
  grab(place);
  statics_.stretch_rest(inputs().rest_stretches(time));
  Equilibrium at = statics_.settle(input, loads, near);
  if (!at.converged())
    throw SimulationError(fmt::format(
        "at {:.3f} s the arm has no equilibrium under its tendons and loads: {}", time, words(at.end)));
  return at;
}

}  // namespace flexura
