#include "flexura/safety/contact_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "flexura/safety/limits.h"
#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

constexpr double half_turn = std::numbers::pi;
constexpr double deepest = -contact_tolerance;  // clearance that is none yet
constexpr QuantityBounds free_of_contact{-no_distance, -no_distance};
constexpr QuantityBounds in_contact{no_distance, no_distance};

QuantityBounds undecided(double moved) { return {-no_distance, contact_tolerance + moved}; }

double largest_radius(const TubeArc& tube) { return std::max(tube.radius[0], tube.radius[1]); }

double turn_between(const TubeArc& a, const TubeArc& b) { return b.turn + b.bend.norm() - a.turn; }

// Distance between two sections' tubes that is surely there.
double apart(const TubeArc& a, const Eigen::Vector3d& middle_a, const TubeArc& b,
             const Eigen::Vector3d& middle_b) {
  return (middle_a - middle_b).norm() - (a.length + b.length) / 2 - largest_radius(a) - largest_radius(b);
}

// What is between two sections, from the first on: whether points of theirs with less than half a turn
// between them can meet. They cannot where nothing is thinner than the two on average, nor where the backbone
// bends no sharper than a circle of that radius.
class Between {
 public:
  // Adds section `tube`, whose bend and length may be other by so much.
  void extend(const TubeArc& tube, double turn, double stretch) {
    const double length = tube.length - stretch;
    sharpest_ = length > 0 ? std::min(sharpest_, length / (tube.bend.norm() + turn)) : 0;
    thinnest_ = std::min(thinnest_, largest_radius(tube));
    turned_ += turn;
    stretched_ += stretch;
  }
  // Which pairs of points of the sections a and b to ask of, where what may change counts (sign -1: all that
  // may count; 1: those that surely do).
  [[nodiscard]] PairRule rule(const TubeArc& a, const TubeArc& b, double sign) const {
    constexpr double rounding = 1e-9;
    const double mean = (largest_radius(a) + largest_radius(b)) / 2;
    const bool is_gentle = std::max(sharpest_, thinnest_) >= mean * (1 - rounding);
    return {half_turn + sign * turned_, is_gentle ? no_distance : sign * stretched_};
  }

 private:
  double sharpest_ = no_distance;  // least radius of curvature, m
  double thinnest_ = no_distance;
  double turned_ = 0;
  double stretched_ = 0;
};

bool has_pairs(const TubeArc& a, const TubeArc& b, const PairRule& rule) {
  return turn_between(a, b) >= rule.turn || rule.gap < no_distance;
}

// The tube with its radius changed by so much at its start and end.
TubeArc grown(TubeArc tube, double at_start, double at_end) {
  tube.radius[0] += at_start;
  tube.radius[1] += at_end;
  return tube;
}

std::vector<Eigen::Vector3d> middles(const std::vector<TubeArc>& tubes) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(tubes.size());
  for (const TubeArc& tube : tubes) points.push_back(tube.point(0.5));
  return points;
}

}  // namespace

// How far the arm may come from its state in the middle of an interval.
struct ContactWatch::Reach {
  std::vector<double> turn;     // of each section: change of its bend, rad
  std::vector<double> length;   // the longest it gets, m
  std::vector<double> stretch;  // change of its length, m

  Reach(const Arm& arm, const Motion& motion, const ArmState& middle, double start, double end) {
    const double half = (end - start) / 2;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const SectionRates rates = rates_of(motion, i, start, end);
      turn.push_back(rates.bend * half);
      stretch.push_back(rates.stretch * half * arm.sections[i].length);
      length.push_back(arm.sections[i].length * middle.stretches[i] + stretch.back());
    }
  }

  // Adds section j to a chain: how far its end may move in the frame at the chain's start (or anywhere in the
  // chain's first section). A section that bends by d turns what is beyond it by at most d, and moves its own
  // end by at most d length / 2; in between that is convex, so a line from start to end bounds it.
  void extend(std::size_t j, double& moved, double& turned) const {
    moved += turned * length[j] + turn[j] * length[j] / 2 + stretch[j];
    turned += turn[j];
  }
};

ContactWatch::ContactWatch(Arm arm) : arm_(std::move(arm)) {}
ContactWatch::ContactWatch(Arm arm, Obstacle obstacle)
    : arm_(std::move(arm)), obstacle_(std::move(obstacle)) {}

Contact ContactWatch::contact(const ArmState& state, double cap) const {
  if (!is_possible(state)) return {.clearance = cap};
  const std::vector<TubeArc> tubes = tube_arcs(arm_, state);
  return obstacle_ ? obstacle_contact(tubes, cap) : self_contact(tubes, cap);
}

std::vector<Contact> ContactWatch::contacts(const ArmState& state) const {
  if (!is_possible(state)) return {};
  const std::vector<TubeArc> tubes = tube_arcs(arm_, state);
  if (!obstacle_) return self_contacts(tubes);
  std::vector<Contact> found;
  for (std::size_t j = 0; j < tubes.size(); ++j) {
    const double distance = obstacle_distance(tubes[j], ignored(j), *obstacle_, {.cap = deepest});
    if (distance < deepest) found.push_back({distance, j, std::nullopt});
  }
  return found;
}

WatchedQuantity ContactWatch::depth(const Motion& motion) const {
  return {[this, &motion](double t) { return -contact(motion.at(t), deepest).clearance; },
          [this, &motion](double start, double end) { return bounds(motion, start, end); }};
}

QuantityBounds ContactWatch::bounds(const Motion& motion, double start, double end) const {
  const ArmState middle = motion.at((start + end) / 2);
  if (!is_possible(middle)) return undecided(contact_motion);  // by its samples
  const Reach reach(arm_, motion, middle, start, end);
  const std::vector<TubeArc> tubes = tube_arcs(arm_, middle);
  return obstacle_ ? obstacle_bounds(tubes, reach) : self_bounds(tubes, reach);
}

QuantityBounds ContactWatch::self_bounds(const std::vector<TubeArc>& tubes, const Reach& reach) {
  const std::vector<Eigen::Vector3d> at = middles(tubes);
  bool is_free = true;
  double most_moved = 0;
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    double moved = 0;
    double turned = 0;
    Between between;
    for (std::size_t j = i; j < tubes.size(); ++j) {
      const double moved_before = moved;
      reach.extend(j, moved, turned);
      between.extend(tubes[j], reach.turn[j], reach.stretch[j]);
      const PairRule possible = between.rule(tubes[i], tubes[j], -1);
      if (!has_pairs(tubes[i], tubes[j], possible)) continue;
      if (apart(tubes[i], at[i], tubes[j], at[j]) >= moved) continue;
      is_free = is_free && stay_apart(tubes[i], grown(tubes[j], moved_before, moved), possible, deepest);
      if (come_within(tubes[i], grown(tubes[j], -moved_before, -moved), between.rule(tubes[i], tubes[j], 1),
                      deepest))
        return in_contact;
    }
    most_moved = std::max(most_moved, moved);
  }
  return is_free ? free_of_contact : undecided(most_moved);
}

// How much of the arm's motion changes its distance to the obstacle: all of it; but where a planar arm stands
// before a plane, only as much as its own plane is tilted to that.
double ContactWatch::share_of_motion() const {
  if (arm_.kind != ArmKind::planar || !obstacle_->normal) return 1;
  const Eigen::Vector3d own = arm_.X_WB.rotation.col(1);
  return (*obstacle_->normal - obstacle_->normal->dot(own) * own).norm();
}

QuantityBounds ContactWatch::obstacle_bounds(const std::vector<TubeArc>& tubes, const Reach& reach) const {
  const double share = share_of_motion();
  bool is_free = true;
  double moved = 0;
  double turned = 0;
  for (std::size_t j = 0; j < tubes.size(); ++j) {
    const double at_start = share * moved;
    reach.extend(j, moved, turned);
    const double at_end = share * moved;
    const double from = ignored(j);
    if (stays_clear(grown(tubes[j], at_start, at_end), from, *obstacle_, deepest)) continue;
    is_free = false;
    if (comes_within(grown(tubes[j], -at_start, -at_end), from, *obstacle_, deepest)) return in_contact;
  }
  return is_free ? free_of_contact : undecided(share * moved);
}

Contact ContactWatch::self_contact(const std::vector<TubeArc>& tubes, double cap) {
  const std::vector<Eigen::Vector3d> at = middles(tubes);
  Contact nearest{.clearance = cap};
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    Between between;
    for (std::size_t j = i; j < tubes.size(); ++j) {
      between.extend(tubes[j], 0, 0);
      const PairRule rule = between.rule(tubes[i], tubes[j], 1);
      if (!has_pairs(tubes[i], tubes[j], rule)) continue;
      if (apart(tubes[i], at[i], tubes[j], at[j]) >= nearest.clearance) continue;
      const double distance = tube_distance(tubes[i], tubes[j], rule, nearest.clearance);
      if (distance < nearest.clearance) nearest = {distance, i, j};
    }
  }
  return nearest;
}

std::vector<Contact> ContactWatch::self_contacts(const std::vector<TubeArc>& tubes) {
  const std::vector<Eigen::Vector3d> at = middles(tubes);
  std::vector<Contact> found;
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    Between between;
    for (std::size_t j = i; j < tubes.size(); ++j) {
      between.extend(tubes[j], 0, 0);
      const PairRule rule = between.rule(tubes[i], tubes[j], 1);
      if (!has_pairs(tubes[i], tubes[j], rule)) continue;
      if (apart(tubes[i], at[i], tubes[j], at[j]) >= deepest) continue;
      const double distance = tube_distance(tubes[i], tubes[j], rule, deepest);
      if (distance < deepest) found.push_back({distance, i, j});
    }
  }
  return found;
}

Contact ContactWatch::obstacle_contact(const std::vector<TubeArc>& tubes, double cap) const {
  Contact nearest{.clearance = cap};
  for (std::size_t j = 0; j < tubes.size(); ++j) {
    const double distance = obstacle_distance(tubes[j], ignored(j), *obstacle_, {.cap = nearest.clearance});
    if (distance < nearest.clearance) nearest = {distance, j, std::nullopt};
  }
  return nearest;
}

// The fraction of a section that the obstacle does not count.
double ContactWatch::ignored(std::size_t section) const {
  double rest = obstacle_->ignore_base;
  for (std::size_t i = 0; i < section; ++i) rest -= arm_.sections[i].length;
  return std::max(0.0, rest / arm_.sections[section].length);
}

}  // namespace flexura
