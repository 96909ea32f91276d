#include "flexura/sim/dynamic_plant.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

constexpr RodDynamicsConfig plant_config{};
// Of a step that does not converge.
constexpr int most_halvings = 8;
// Of a step, what counts as none.
constexpr double no_time = 1e-9;
// Nearer to each other two places of a section are one (RodDynamics).
constexpr double one_place = 1e-9;
// Of strains times a section's length: more is no arm any more, but a motion that blew up.
constexpr double greatest_strain = 1e4;

const ArmRod& moving_rod(const PlantSetup& setup) {
  if (!setup.truth.rod || !setup.truth.rod->time_step)
    throw std::invalid_argument("the true arm is no rod in motion");
  return *setup.truth.rod;
}

// That are nodes: what carries.
std::vector<RodPlace> places_of(const ArmRod& rod) {
  std::vector<RodPlace> places;
  places.reserve(rod.payloads.size());
  for (const ArmRod::Payload& payload : rod.payloads) places.push_back(payload.payload.place);
  return places;
}

}  // namespace

DynamicPlant::DynamicPlant(const PlantSetup& setup)
    : RodPlant(setup),
      rod_(moving_rod(setup)),
      X_WB_(setup.truth.arm.X_WB),
      step_(setup.truth.rod->time_step.value()),
      horizon_(setup.horizon),
      dynamics_(inputs().rod(), plant_config, places_of(rod_)),
      carried_(rod_.payloads.size(), 0) {
  if (rod_.contact)
    for (const Obstacle& obstacle : obstacles(rod_.contact->obstacles)) names_.push_back(obstacle.name);
  surround();
  double base = 0;
  for (const RodSection& section : inputs().rod().sections) {
    bases_.push_back(base);
    base += section.length;
  }
  const std::vector<double> lost = inputs().nothing_lost();
  RodStatics statics(inputs().rod());
  const Equilibrium rest =
      statics.solve({.displacements = inputs().displacements(0, lost)}, inputs().loads(0));
  if (!rest.converged())
    throw std::invalid_argument(
        fmt::format("the arm comes to no rest from which it could begin: {}", words(rest.end)));
  snapshots_.push_back({0, dynamics_.rest(rest), lost, carried_});
  hand_over(snapshots_.back(), 0);
}

DynamicPlant::~DynamicPlant() = default;

// What is around the rod, at the nodes that it has.
void DynamicPlant::surround() const {
  std::vector<const RodSurroundings*> around;
  if (rod_.contact) around.push_back(&contact_.emplace(dynamics_.chain(), *rod_.contact));
  if (rod_.drag) around.push_back(&drag_.emplace(dynamics_.chain(), *rod_.drag));
  if (grabbed_) around.push_back(&spring_.emplace(dynamics_.chain(), *grabbed_));
  dynamics_.set_surroundings(around.empty() ? nullptr : &surroundings_.emplace(around));
}

// The point that is pushed becomes a node. States stay what they are: nodes beside those that integrals are
// taken at change nothing of the rod.
void DynamicPlant::grab(const std::optional<RodPlace>& place) const {
  if (place == grabbed_) return;
  std::vector<RodPlace> places = places_of(rod_);
  if (place) places.push_back(*place);
  dynamics_ = RodDynamics(inputs().rod(), plant_config, places);
  grabbed_ = place;
  carried_.assign(rod_.payloads.size(), 0);
  surround();
}

std::optional<RodPlace> DynamicPlant::grabbed_at(double time) const {
  const std::optional<PointSpring> spring = inputs().spring(time);
  return spring ? std::optional(RodPlace{spring->section, spring->at}) : std::nullopt;
}

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
      grab(grabbed_at(time_of(then.index)));
      carry(then.carried);
      go_on(then.state, time_of(then.index), step_, then.lost, 0);
      hand_over(then, time_of(next));
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
  // One that is pushed elsewhere meanwhile is so from the next step on.
  if (grabbed_) spring_->set(grabbed_at(middle) == grabbed_ ? inputs().spring(middle) : std::nullopt);
  const RodStep step = dynamics_.step(state, input, inputs().loads(middle), h);
  if (step.converged()) {
    const bool is_an_arm =
        state.q.allFinite() &&
        state.q.cwiseProduct(dynamics_.chain().scales()).cwiseAbs().maxCoeff() < greatest_strain;
    if (!is_an_arm)
      throw SimulationError(
          fmt::format("at {:.4f} s the motion of the arm blows up: what moves it is too strong for steps of "
                      "{} s",
                      from, step_));
    return;
  }
  if (step.end == DynamicsEnd::bad_input || halvings == most_halvings)
    throw SimulationError(fmt::format("at {:.4f} s the motion of the arm cannot be computed: {}", from,
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
  grab(grabbed_at(time_of(from.index)));
  carry(from.carried);
  const double start = time_of(from.index);
  if (time - start > no_time * step_) go_on(state, start, time - start, from.lost, 0);
  answer_ = {.time = time, .state = state};
  return state;
}

Backbone DynamicPlant::backbone(double time) const {
  const RodState state = state_at(time);
  try {
    return tube().backbone(state.q, inputs().rest_stretches(time));
  } catch (const std::invalid_argument&) {
    throw SimulationError(fmt::format(
        "at {:.4f} s the motion of the arm blows up: it winds more tightly than an arm can", time));
  }
}

std::vector<double> DynamicPlant::tensions(double time) const { return state_at(time).tensions; }

std::optional<RodEnergy> DynamicPlant::energy(double time) const {
  const RodState state = state_at(time);
  const std::lock_guard lock(mutex_);
  carry(snapshot(time).carried);
  return dynamics_.energy(state, inputs().loads(time));
}

std::vector<char> DynamicPlant::carried_at(double time) const {
  std::vector<char> carried;
  carried.reserve(rod_.payloads.size());
  for (const ArmRod::Payload& payload : rod_.payloads)
    carried.push_back(payload.from <= time && time < payload.until ? 1 : 0);
  return carried;
}

// The rod gets the masses of these payloads, whatever its state.
void DynamicPlant::carry(const std::vector<char>& wanted) const {
  if (carried_ == wanted) return;
  const RodState any = dynamics_.rest();
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (carried_[i] != 0) (void)dynamics_.drop(any, rod_.payloads[i].payload.place, {}, {});
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i] != 0) (void)dynamics_.pick_up(any, rod_.payloads[i].payload, {}, {});
  carried_ = wanted;
}

// Payloads are picked up and dropped: a state of what was carried becomes one of what is from now on.
void DynamicPlant::hand_over(Snapshot& at, double time) const {
  const std::vector<char> wanted = carried_at(time);
  if (at.carried == wanted) return;
  const TendonInput input{.displacements = inputs().displacements(time, at.lost)};
  const RodLoads& loads = inputs().loads(time);
  std::vector<char> left = at.carried;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const RodPlace& place = rod_.payloads[i].payload.place;
    if (left[i] == 0 || wanted[i] != 0) continue;
    at.state = dynamics_.drop(at.state, place, input, loads);
    // All that was carried there is dropped.
    for (std::size_t k = 0; k < left.size(); ++k) {
      const RodPlace& other = rod_.payloads[k].payload.place;
      if (other.section == place.section && std::abs(other.at - place.at) <= one_place) left[k] = 0;
    }
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == 0 || left[i] != 0) continue;
    RodPayload payload = rod_.payloads[i].payload;
    if (at.carried[i] != 0) {
      // It is held on, and moves as its place does.
      const NodeMotion motion = dynamics_.motion(at.state, payload.place);
      const Eigen::Vector3d p = motion.pose * payload.offset;
      payload.velocity = motion.twist.head<3>() + motion.twist.tail<3>().cross(p);
    }
    at.state = dynamics_.pick_up(at.state, payload, input, loads);
  }
  at.carried = carried_ = wanted;
}

// A time is asked for twice, for what is recorded and for the warning: they are searched once.
std::vector<PlantContact> DynamicPlant::contacts(double time) const {
  if (!contact_) return {};
  const RodState state = state_at(time);
  const std::lock_guard lock(mutex_);
  if (answer_ && answer_->time == time && answer_->contacts) return *answer_->contacts;
  carry(snapshot(time).carried);
  std::vector<PlantContact> result = found(contact_->find(dynamics_.point_motions(state)));
  if (answer_ && answer_->time == time) answer_->contacts = result;
  return result;
}

std::vector<PlantContact> DynamicPlant::found(const std::vector<ContactForce>& contacts) const {
  std::vector<PlantContact> result;
  result.reserve(contacts.size());
  for (const ContactForce& each : contacts) {
    const RodSection& section = inputs().rod().sections[each.place.section];
    result.push_back({.s_rest = bases_[each.place.section] + each.place.at * section.length,
                      .with = each.obstacle ? names_[*each.obstacle] : "the arm",
                      .point = X_WB_ * each.point,
                      .force = X_WB_.rotation * each.force,
                      .depth = each.depth,
                      .normal_force = each.normal_force,
                      .sticks = each.sticks,
                      .is_deep = each.is_deep});
  }
  return result;
}

std::string DynamicPlant::warning(double time) const {
  for (const PlantContact& contact : contacts(time))
    if (contact.is_deep)
      return fmt::format("the arm is deep inside {}: what that pushes means nothing", contact.with);
  return {};
}

}  // namespace flexura
