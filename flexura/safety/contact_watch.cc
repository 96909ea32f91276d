#include "flexura/safety/contact_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flexura {
namespace {

constexpr double deepest = -contact_tolerance;  // Smallest clearance that is not a contact, m.
constexpr QuantityBounds free_of_contact{-no_distance, -no_distance};
constexpr QuantityBounds in_contact{no_distance, no_distance};

QuantityBounds undecided(double moved) { return {-no_distance, contact_tolerance + moved}; }

// Returns the clearance of two backbone points at the same position, which is the smallest possible
// clearance.
double deepest_pair(const SectionTube& a, const SectionTube& b) {
  return -std::max(a.radius[0], a.radius[1]) - std::max(b.radius[0], b.radius[1]);
}

// Returns the fraction of each section that is ignored if `ignore_base`, m, of the arm is ignored.
std::vector<double> ignored_fractions(const Arm& arm, double ignore_base) {
  std::vector<double> fractions;
  for (const Section& section : arm.sections) {
    fractions.push_back(std::max(0.0, ignore_base / section.length));
    ignore_base -= section.length;
  }
  return fractions;
}

// Returns the fraction of the arm's motion that can change its distance to an obstacle. For a planar arm and
// a plane this is the sine of the angle between both planes, otherwise 1.
double share_of_motion(const Arm& arm, const Obstacle& obstacle) {
  if (arm.kind != ArmKind::planar || !obstacle.normal) return 1;
  const Eigen::Vector3d own = arm.X_WB.rotation.col(1);
  return (*obstacle.normal - obstacle.normal->dot(own) * own).norm();
}

}  // namespace

ContactWatch::ContactWatch(Arm arm) : arm_(std::move(arm)) {}
ContactWatch::ContactWatch(Arm arm, Obstacle obstacle)
    : arm_(std::move(arm)),
      obstacle_(std::move(obstacle)),
      ignored_(ignored_fractions(arm_, obstacle_->ignore_base)),
      share_(share_of_motion(arm_, *obstacle_)) {}

Contact ContactWatch::place_of(std::size_t first, std::size_t last) const {
  if (obstacle_) return {.section = last};
  return {.section = first, .other_section = last};
}

void ContactWatch::for_each_chain(
    const std::function<void(std::size_t first, std::size_t last)>& visit) const {
  const std::size_t count = arm_.sections.size();
  for (std::size_t first = 0; first < (obstacle_ ? 1 : count); ++first) {
    for (std::size_t last = first; last < count; ++last) visit(first, last);
  }
}

template <class Visit>
void ContactWatch::for_each_chain_of(const ArmState& state, const Visit& visit) const {
  const Swing rest(arm_, state);
  if (!rest.is_possible()) return;
  Chain chain(rest, 0);
  for_each_chain([&](std::size_t first, std::size_t last) {
    chain.go_to(first, last);
    visit(chain);
  });
}

Contact ContactWatch::contact(const ArmState& state, double cap) const {
  Contact nearest{.clearance = cap};
  for_each_chain_of(state, [&](const Chain& chain) {
    const double now = clearance(chain, {.cap = nearest.clearance});
    if (!(now < nearest.clearance)) return;
    nearest = place_of(chain.first(), chain.last());
    nearest.clearance = now;
  });
  return nearest;
}

std::vector<Contact> ContactWatch::contacts(const ArmState& state) const {
  std::vector<Contact> found;
  for_each_chain_of(state, [&](const Chain& chain) {
    const double now = clearance(chain, {.cap = deepest});
    if (!(now < deepest)) return;
    found.push_back(place_of(chain.first(), chain.last()));
    found.back().clearance = now;
  });
  return found;
}

double ContactWatch::clearance(const Chain& chain, const DistanceQuery& query) const {
  if (obstacle_) return obstacle_distance(chain.grown(1, share_), ignored_[chain.last()], *obstacle_, query);
  const PairRule rule = chain.rule(-1);
  if (!chain.has_pairs(rule) || chain.apart() - chain.moved() >= query.cap) return query.cap;
  const double least = deepest_pair(chain.first_tube(), chain.last_tube());
  return std::max(least, tube_distance(chain.first_tube(), chain.grown(1), rule, query));
}

QuantityBounds ContactWatch::bounds(const Chain& chain) const {
  return obstacle_ ? obstacle_bounds(chain) : self_bounds(chain);
}

QuantityBounds ContactWatch::self_bounds(const Chain& chain) {
  const PairRule possible = chain.rule(-1);
  if (!chain.has_pairs(possible) || chain.apart() >= chain.moved()) return free_of_contact;
  const SectionTube& first = chain.first_tube();
  if (stay_apart(first, chain.grown(1), possible, deepest)) return free_of_contact;
  const SectionTube thin = chain.grown(-1);
  const bool may_meet = deepest_pair(first, thin) < deepest;  // A tube made thinner may vanish.
  if (may_meet && come_within(first, thin, chain.rule(1), deepest)) return in_contact;
  return undecided(chain.moved());
}

QuantityBounds ContactWatch::obstacle_bounds(const Chain& chain) const {
  const double from = ignored_[chain.last()];
  if (stays_clear(chain.grown(1, share_), from, *obstacle_, deepest)) return free_of_contact;
  if (comes_within(chain.grown(-1, share_), from, *obstacle_, deepest)) return in_contact;
  return undecided(share_ * chain.moved());
}

ContactDepths::ContactDepths(const Arm& arm, const std::vector<ContactWatch>& watches, const Motion& motion)
    : arm_(arm), watches_(watches), motion_(motion) {
  for (std::size_t watch = 0; watch < watches.size(); ++watch) {
    watches[watch].for_each_chain(
        [&](std::size_t first, std::size_t last) { parts_.push_back({watch, first, last}); });
  }
}

void ContactDepths::find_values(double time, std::span<const std::size_t> which,
                                std::span<double> values) const {
  std::ranges::fill(values, contact_tolerance);
  const Swing rest(arm_, motion_.at(time));
  if (!rest.is_possible()) return;
  Chain chain(rest, 0);
  for (std::size_t k = 0; k < which.size(); ++k) {
    const Part& part = parts_[which[k]];
    chain.go_to(part.first, part.last);
    values[k] = -watches_[part.watch].clearance(chain, {deepest, deepest});
  }
}

void ContactDepths::find_bounds(const Span& span, std::span<const std::size_t> which,
                                std::span<QuantityBounds> bounds) const {
  std::ranges::fill(bounds, undecided(contact_motion));  // An impossible arm is decided by samples.
  const Swing swing(arm_, motion_, span);
  if (!swing.is_possible()) return;
  Chain chain(swing, 0);
  for (std::size_t k = 0; k < which.size(); ++k) {
    const Part& part = parts_[which[k]];
    chain.go_to(part.first, part.last);
    bounds[k] = watches_[part.watch].bounds(chain);
  }
}

WatchedQuantity ContactDepths::depth(std::size_t i) const {
  const auto depth_in = [this, part = parts_[i]](const Swing& swing) {
    if (!swing.is_possible()) return contact_tolerance;
    Chain chain(swing, part.first);
    chain.go_to(part.first, part.last);
    return -watches_[part.watch].clearance(chain, {.cap = deepest});
  };
  const auto value = [this, depth_in](double time) { return depth_in(Swing(arm_, motion_.at(time))); };
  const auto bounds = [this, depth_in](double start, double end) -> QuantityBounds {
    return {-no_distance, depth_in(Swing(arm_, motion_, {start, end}))};
  };
  return {value, bounds};
}

}  // namespace flexura
