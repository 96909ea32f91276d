#include "flexura/sim/dynamic_plant.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

constexpr RodDynamicsConfig plant_config{};
// Of a step that does not converge.
constexpr int most_halvings = 8;
// Of a step, what counts as none.
constexpr double no_time = 1e-9;

}  // namespace

DynamicPlant::DynamicPlant(const PlantSetup& setup)
    : RodPlant(setup),
      step_(setup.truth.rod->time_step.value()),
      horizon_(setup.horizon),
      dynamics_(inputs().rod(), plant_config) {
  const std::vector<double> lost = inputs().nothing_lost();
  RodStatics statics(inputs().rod());
  const Equilibrium rest =
      statics.solve({.displacements = inputs().displacements(0, lost)}, inputs().loads(0));
  if (!rest.converged())
    throw std::invalid_argument(
        fmt::format("the arm comes to no rest from which it could begin: {}", words(rest.end)));
  snapshots_.push_back({0, dynamics_.rest(rest), lost});
}

DynamicPlant::~DynamicPlant() = default;

void DynamicPlant::forget() {
  const std::lock_guard lock(mutex_);
  answer_.reset();
}

void DynamicPlant::advance(double time) {
  forget();
  const long last = static_cast<long>(std::floor(time / step_ + no_time));
  for (long next = snapshots_.back().index + 1; next <= last; ++next) {
    Snapshot then = snapshots_.back();
    {
      const std::lock_guard lock(mutex_);
      go_on(then.state, time_of(then.index), step_, then.lost, 0);
    }
    then.index = next;
    // What a motor loses lets its tendon out from the next step on.
    (void)inputs().lose_steps(time_of(next), then.state.tensions, then.lost);
    snapshots_.push_back(std::move(then));
  }
  const double oldest = time - horizon_ - 2 * step_;
  std::size_t gone = 0;
  while (gone + 1 < snapshots_.size() && time_of(snapshots_[gone + 1].index) < oldest) ++gone;
  snapshots_.erase(snapshots_.begin(), snapshots_.begin() + static_cast<std::ptrdiff_t>(gone));
  inputs().forget_before(oldest);
}

void DynamicPlant::go_on(RodState& state, double from, double h, const std::vector<double>& lost,
                         int halvings) const {
  const double middle = from + h / (1 + plant_config.spectral_radius);
  const TendonInput input{.displacements = inputs().displacements(middle, lost)};
  const RodStep step = dynamics_.step(state, input, inputs().loads(middle), h);
  if (step.converged()) return;
  if (step.end == DynamicsEnd::bad_input || halvings == most_halvings)
    throw std::runtime_error(fmt::format("at {:.4f} s the motion of the arm cannot be computed: {}", from,
                                         step.problem.empty() ? words(step.end) : step.problem));
  go_on(state, from, h / 2, lost, halvings + 1);
  go_on(state, from + h / 2, h / 2, lost, halvings + 1);
}

const DynamicPlant::Snapshot& DynamicPlant::snapshot(double time) const {
  std::size_t from = snapshots_.size() - 1;
  while (from > 0 && time_of(snapshots_[from].index) > time + no_time * step_) --from;
  return snapshots_[from];
}

RodState DynamicPlant::state_at(double time) const {
  const std::lock_guard lock(mutex_);
  if (answer_ && answer_->time == time) return answer_->state;
  const Snapshot& from = snapshot(time);
  RodState state = from.state;
  const double start = time_of(from.index);
  if (time - start > no_time * step_) go_on(state, start, time - start, from.lost, 0);
  answer_ = {time, state};
  return state;
}

Backbone DynamicPlant::backbone(double time) const {
  return tube().backbone(state_at(time).q, inputs().rest_stretches(time));
}

std::vector<double> DynamicPlant::tensions(double time) const { return state_at(time).tensions; }

std::optional<RodEnergy> DynamicPlant::energy(double time) const {
  const RodState state = state_at(time);
  const std::lock_guard lock(mutex_);
  return dynamics_.energy(state, inputs().loads(time));
}

}  // namespace flexura
