#include "flexura/sim/static_plant.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "flexura/mechanics/arm_rod.h"
#include "flexura/port/driven_arm.h"

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
  }
  for (const RodElement& element : fine_.elements()) {
    std::vector<std::size_t>& nodes = fine_nodes_.emplace_back();
    for (std::size_t k = 0; k <= samples_a_section; ++k)
      nodes.push_back(
          element.grid().node_at(static_cast<double>(k) / static_cast<double>(samples_a_section)));
  }
  const std::size_t tendons = fine_.rod().tendons.size();
  tight_.assign(tendons, 0.0);
  if (drive_ && drive_->pretension > 0) tight_ = pretension_displacements(statics_, drive_->pretension);
  snapshots_.push_back(settled(0, {0, {}, std::vector<double>(drive_ ? tendons : 0, 0.0)}));
}

void StaticPlant::command(double time, const Eigen::VectorXd& u, double duration) {
  if (motors_) {
    motors_->command(time, {u.data(), static_cast<std::size_t>(u.size())}, duration);
  } else {
    bends_->command(time, commanded_state(u), duration);
  }
}

void StaticPlant::halt(double time) {
  if (motors_) {
    motors_->halt(time);
  } else {
    bends_->halt(time);
  }
}

void StaticPlant::advance(double time) {
  const long last = static_cast<long>(std::floor(time / step));
  for (long next = snapshots_.back().index + 1; next <= last; ++next) {
    snapshots_.push_back(settled(next, snapshots_.back()));
  }
  const double oldest = time - horizon_ - 2 * step;
  std::size_t gone = 0;
  while (gone + 1 < snapshots_.size() && static_cast<double>(snapshots_[gone + 1].index) * step < oldest)
    ++gone;
  snapshots_.erase(snapshots_.begin(), snapshots_.begin() + static_cast<std::ptrdiff_t>(gone));
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
  const Snapshot& from = snapshot(time);
  return solved(time, from.at, from.lost);
}

std::optional<ArmState> StaticPlant::commanded(double time) const {
  if (motors_) return shape_carried(arm_, *drive_, zero_, motors_->carried(time));
  return bends_->at(time);
}

std::vector<double> StaticPlant::displacements(double time, const std::vector<double>& lost) const {
  if (!motors_) return arc_displacements(fine_.rod(), bends_->at(time)).pulled;
  std::vector<double> pulled = displacements_carried(*drive_, zero_, motors_->carried(time)).pulled;
  for (std::size_t i = 0; i < pulled.size(); ++i)
    pulled[i] += tight_[i] - lost[i] / drive_->axes[i].microsteps_a_metre();
  return pulled;
}

// How long its sections are by themselves; behind a drive, as their description says.
std::vector<double> StaticPlant::rest_stretches(double time) const {
  if (bends_) return bends_->at(time).stretches;
  return std::vector<double>(arm_.sections.size(), 1.0);
}

Equilibrium StaticPlant::solved(double time, const Equilibrium& near, const std::vector<double>& lost) const {
  const TendonInput input{.displacements = displacements(time, lost)};
  const std::lock_guard lock(mutex_);
  statics_.stretch_rest(rest_stretches(time));
  Equilibrium at = statics_.solve(input, loads_, near);
  if (!at.converged())
    throw std::runtime_error(fmt::format(
        "at {:.3f} s the arm comes to no rest under its tendons and loads: {}", time, words(at.end)));
  return at;
}

Backbone StaticPlant::backbone_of(double time, const Equilibrium& at) const {
  std::vector<BackboneSample> samples;
  {
    const std::lock_guard lock(mutex_);
    fine_.stretch_rest(rest_stretches(time));
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
