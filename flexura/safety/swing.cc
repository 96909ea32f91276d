#include "flexura/safety/swing.h"

#include <algorithm>
#include <numbers>

#include "flexura/safety/limits.h"
#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

double largest_radius(const SectionTube& tube) { return std::max(tube.radius[0], tube.radius[1]); }

}  // namespace

Swing::Swing(const Arm& arm, const ArmState& state)
    : turn_(arm.sections.size()), stretch_(arm.sections.size()) {
  if (!flexura::is_possible(state)) return;
  tubes_ = tube_arcs(arm, state);
  for (const SectionTube& tube : tubes_) length_.push_back(tube.length);
}

Swing::Swing(const Arm& arm, const Motion& motion, const Span& span)
    : Swing(arm, motion.at((span.start + span.end) / 2)) {
  const double half = (span.end - span.start) / 2;
  for (std::size_t i = 0; i < tubes_.size(); ++i) {
    const SectionRates rates = rates_of(motion, i, span.start, span.end);
    turn_[i] = rates.bend * half;
    stretch_[i] = rates.stretch * half * arm.sections[i].length;
    length_[i] += stretch_[i];
  }
}

Chain::Chain(const Swing& swing, std::size_t first) : swing_(&swing) { restart(first); }

void Chain::go_to(std::size_t first, std::size_t last) {
  if (first != first_ || last < last_) restart(first);
  while (last_ < last) add(last_ + 1);
}

void Chain::restart(std::size_t first) {
  first_ = first;
  moved_ = turned_ = stretched_ = 0;
  sharpest_ = thinnest_ = no_distance;
  middle_ = swing_->tubes_[first].point(0.5);
  add(first);
}

// If the bend of a section changes by d, everything beyond the section rotates by at most d, and the
// section's end moves by at most d length / 2. The motion along the section is convex, so that a straight
// line from start to end bounds it.
void Chain::add(std::size_t section) {
  last_ = section;
  const SectionTube& tube = last_tube();
  const double turn = swing_->turn_[section];
  const double stretch = swing_->stretch_[section];
  moved_before_ = moved_;
  moved_ += turned_ * swing_->length_[section] + turn * swing_->length_[section] / 2 + stretch;
  turned_ += turn;
  stretched_ += stretch;
  const double shortest = tube.length - stretch;
  sharpest_ = shortest > 0 ? std::min(sharpest_, shortest / (tube.bend.norm() + turn)) : 0;
  thinnest_ = std::min(thinnest_, largest_radius(tube));
}

SectionTube Chain::grown(double sign, double share) const {
  SectionTube tube = last_tube();
  tube.radius[0] += sign * share * moved_before_;
  tube.radius[1] += sign * share * moved_;
  return tube;
}

// Returns the rule for pairs of points. Pairs with less than half a turn between them cannot touch in two
// cases. Either no section between is thinner than the average of the two, or the curvature is at most that
// of a circle with this radius.
PairRule Chain::rule(double sign) const {
  constexpr double rounding = 1e-9;
  const double mean = (largest_radius(first_tube()) + largest_radius(last_tube())) / 2;
  const bool is_gentle = std::max(sharpest_, thinnest_) >= mean * (1 - rounding);
  return {std::numbers::pi + sign * turned_, is_gentle ? no_distance : sign * stretched_};
}

bool Chain::has_pairs(const PairRule& rule) const {
  const SectionTube& b = last_tube();
  return b.turn + b.bend.norm() - first_tube().turn >= rule.turn || rule.gap < no_distance;
}

double Chain::apart() const {
  const SectionTube& a = first_tube();
  const SectionTube& b = last_tube();
  return (middle_ - b.point(0.5)).norm() - (a.length + b.length) / 2 - largest_radius(a) - largest_radius(b);
}

}  // namespace flexura
