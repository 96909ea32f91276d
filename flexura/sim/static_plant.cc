#include "flexura/sim/static_plant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "flexura/mechanics/arm_rod.h"
#include "flexura/port/driven_arm.h"
#include "flexura/sim/tendon_pull.h"

namespace flexura {
namespace {

// Of fields in one step: then it goes on losing in the next.
constexpr int most_turns = 50;

// Of the backbone that is shown, for each section.
constexpr std::size_t samples_a_section = 12;

std::vector<RodPlace> fine_places(const Rod& rod) {
  std::vector<RodPlace> places;
  for (std::size_t i = 0; i < rod.sections.size(); ++i)
    for (std::size_t k = 0; k <= samples_a_section; ++k)
      places.push_back({i, static_cast<double>(k) / static_cast<double>(samples_a_section)});
  return places;
}

std::vector<std::int64_t> microsteps(const Eigen::VectorXd& u) {
  std::vector<std::int64_t> positions;
  for (const double position : u) positions.push_back(std::llround(position));
  return positions;
}

const ArmRod& rod_in(const PlantSetup& setup) {
  if (!setup.truth.rod) throw std::invalid_argument("the true arm is no rod");
  if (setup.truth.drive && setup.truth.drive->axes.size() != setup.truth.rod->rod.tendons.size())
    throw std::invalid_argument(
        fmt::format("the arm has {} tendons: expected {}, one for each axis of its drive",
                    setup.truth.rod->rod.tendons.size(), setup.truth.drive->axes.size()));
  return *setup.truth.rod;
}

}  // namespace

StaticPlant::StaticPlant(const PlantSetup& setup)
    : arm_(setup.truth.arm),
      loads_(rod_in(setup).loads),
      horizon_(setup.horizon),
      drive_(setup.truth.drive),
      statics_(setup.truth.rod->rod),
      fine_(setup.truth.rod->rod, fine_places(setup.truth.rod->rod)) {
  if (drive_) {
    motors_.emplace(*drive_, *drive_, microsteps(setup.start), setup.horizon);
    zero_ = displacements_at_zero(arm_, *drive_, setup.truth.initial, microsteps(setup.start));
  } else {
    bends_.emplace(arm_, setup.truth.initial, setup.horizon);
    beside_.emplace(fine_.rod().tendons.size(), setup.horizon);
  }
  for (const RodElement& element : fine_.elements()) {
    std::vector<std::size_t>& nodes = fine_nodes_.emplace_back();
    for (std::size_t k = 0; k <= samples_a_section; ++k)
      nodes.push_back(
          element.grid().node_at(static_cast<double>(k) / static_cast<double>(samples_a_section)));
  }
  const std::size_t tendons = fine_.rod().tendons.size();
  tight_.assign(tendons, 0.0);
  if (drive_ && drive_->pretension > 0) {
    const Equilibrium tight =
        statics_.solve({.tensions = std::vector<double>(tendons, drive_->pretension)}, {});
    if (!tight.converged()) throw std::invalid_argument("the arm comes to no rest under its pretension");
    tight_ = tight.displacements;
  }
  snapshots_.push_back(settled(0, {0, {}, std::vector<double>(drive_ ? tendons : 0, 0.0), false}));
}

void StaticPlant::command(double time, const Eigen::VectorXd& u, double duration) {
  if (motors_) {
    motors_->command(time, {u.data(), static_cast<std::size_t>(u.size())}, duration);
  } else {
    bends_->command(time, commanded_state(u), duration);
    beside_->back(time, bends_->end());
  }
  forget();
}

void StaticPlant::halt(double time) {
  if (motors_) {
    motors_->halt(time);
  } else {
    bends_->halt(time);
    beside_->halt(time);
  }
  forget();
}

std::optional<ArmState> StaticPlant::pull(double time, const std::vector<double>& displacements,
                                          double duration) {
  if (!bends_) return std::nullopt;
  ArmState nearest = nearest_arcs(fine_.rod(), arm_, displacements);
  bends_->command(time, nearest, duration);
  // Drawn to the limits of its sections, arcs may end elsewhere.
  const ArmState end = bends_->at(std::numeric_limits<double>::max());
  std::vector<double> beside = displacements;
  const std::vector<double> by_arcs = arc_displacements(fine_.rod(), end).pulled;
  for (std::size_t i = 0; i < beside.size(); ++i) beside[i] -= by_arcs[i];
  beside_->command(time, std::move(beside), bends_->end());
  forget();
  return nearest;
}

bool StaticPlant::weigh(double time, bool on) {
  if (!has_loads(loads_)) return false;
  weighings_.push_back({time, on});
  forget();
  return true;
}

bool StaticPlant::is_weighed(double time) const {
  const auto last = std::ranges::find_if(weighings_.rbegin(), weighings_.rend(),
                                         [time](const Weighing& each) { return each.time <= time; });
  return last == weighings_.rend() || last->on;
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
  // Those of before the oldest were all that counted for it.
  while (weighings_.size() > 1 && weighings_[1].time < oldest) weighings_.erase(weighings_.begin());
  forget();
}

// What becomes of a snapshot by a later step.
StaticPlant::Snapshot StaticPlant::settled(long index, Snapshot from) const {
  const double then = static_cast<double>(index) * step;
  from.index = index;
  from.at = solved(then, from.at, from.lost);
  // Each turn of its field that a motor loses lets its tendon out, and others take over what it held.
  for (int turn = 0; turn < most_turns && lose_steps(then, from.at, from.lost); ++turn)
    from.at = solved(then, from.at, from.lost);
  return from;
}

bool StaticPlant::lose_steps(double time, const Equilibrium& at, std::vector<double>& lost) const {
  if (!drive_) return false;
  bool any = false;
  const std::vector<double> rates = motors_->rates(time);
  for (std::size_t i = 0; i < lost.size(); ++i) {
    const Axis& axis = drive_->axes[i];
    const double speed = std::abs(rates[i]) * 2 * std::numbers::pi / axis.motor.resolution();
    if (axis.torque(at.tensions[i]) <= axis.motor.pull_out_torque(speed)) continue;
    lost[i] += axis.motor.field_turn();
    any = true;
  }
  return any;
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

std::optional<ArmState> StaticPlant::commanded(double time) const {
  if (motors_) return shape_carried(arm_, *drive_, zero_, motors_->carried(time));
  return bends_->at(time);
}

std::vector<double> StaticPlant::pulled(double time) const {
  if (motors_) return displacements_carried(*drive_, zero_, motors_->carried(time)).pulled;
  std::vector<double> pulled = arc_displacements(fine_.rod(), bends_->at(time)).pulled;
  beside_->add_to(pulled, time);
  return pulled;
}

// Its tip goes much farther than what its tendons do in that time can bend it.
bool StaticPlant::is_jump(const Snapshot& from, const Snapshot& to) const {
  constexpr double least = 0.1, many = 2;  // of its length; of an arm's way whose bend is even
  const double length = fine_.rod().length();
  const double way = (to.at.tip.position - from.at.tip.position).norm();
  if (way < least * length) return false;
  const double start = static_cast<double>(from.index) * step, end = static_cast<double>(to.index) * step;
  if (std::ranges::any_of(weighings_,
                          [&](const Weighing& each) { return each.time > start && each.time <= end; }))
    return false;
  const std::vector<double> before = displacements(start, from.lost), after = displacements(end, to.lost);
  double bent = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    bent += std::abs(after[i] - before[i]) / fine_.rod().tendons[i].at(0).value.norm();
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
    return "the arm snaps: where it lay nothing holds it any more, and it jumps to another equilibrium";
  if (!at.stable) return "the arm rests here, but a small push throws it out of that: it is not stable";
  return {};
}

std::vector<double> StaticPlant::displacements(double time, const std::vector<double>& lost) const {
  std::vector<double> given = pulled(time);
  for (std::size_t i = 0; i < given.size(); ++i) {
    given[i] += tight_[i];
    if (drive_) given[i] -= lost[i] / drive_->axes[i].microsteps_a_metre();
  }
  return given;
}

Equilibrium StaticPlant::solved(double time, const Equilibrium& near, const std::vector<double>& lost) const {
  const TendonInput input{.displacements = displacements(time, lost)};
  const std::lock_guard lock(mutex_);
  static const RodLoads no_loads;
  Equilibrium at = statics_.solve(input, is_weighed(time) ? loads_ : no_loads, near);
  if (!at.converged())
    throw std::runtime_error(fmt::format(
        "at {:.3f} s the arm comes to no rest under its tendons and loads: {}", time, words(at.end)));
  return at;
}

Backbone StaticPlant::backbone_of(const Equilibrium& at) const {
  std::vector<BackboneSample> samples;
  {
    const std::lock_guard lock(mutex_);
    fine_.place(at.q);
    double s_rest = 0;
    for (std::size_t i = 0; i < fine_.elements().size(); ++i) {
      const RodElement& element = fine_.elements()[i];
      const auto& radius = arm_.sections[i].radius;
      const std::vector<double>& t = element.grid().t;
      // A section's end is the next one's base.
      const std::size_t count = samples_a_section + (i + 1 == fine_.elements().size() ? 1 : 0);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t node = fine_nodes_[i][k];
        samples.push_back({.X_WS = arm_.X_WB * element.poses()[node],
                           .s_rest = s_rest + t[node] * element.length(),
                           .radius = radius[0] + t[node] * (radius[1] - radius[0]),
                           .section = i});
      }
      s_rest += element.length();
    }
  }
  return Backbone::through(samples);
}

std::unique_ptr<Plant> true_plant(const PlantSetup& setup) {
  if (setup.truth.rod) return std::make_unique<StaticPlant>(setup);
  return arc_plant(setup);
}

}  // namespace flexura
