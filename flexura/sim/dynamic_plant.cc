#include "flexura/sim/dynamic_plant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

// Longest step while motors may lose microsteps, s: a fifth of the rotor time.
constexpr double rotor_step = rotor_time / 5;
// Interval of the backward difference for the rates of section lengths, s.
constexpr double shortly = 1e-5;
// Fraction of a step below which a duration counts as zero.
constexpr double no_time = 1e-9;
// Parts of a section: places nearer to each other than this are the same (RodDynamics).
constexpr double one_place = 1e-9;
// Limit on strain times section length: beyond it the motion has diverged.
constexpr double greatest_strain = 1e4;

const ArmRod& moving_rod(const PlantSetup& setup) {
  if (!setup.truth.rod || !setup.truth.rod->time_step)
    throw std::invalid_argument("the true arm is not a rod with inertia");
  return *setup.truth.rod;
}

RodDynamicsConfig config_of(const ArmRod& rod) { return {.spectral_radius = rod.spectral_radius}; }

// Returns the places that must be nodes: those of the payloads.
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
      dynamics_(inputs().rod(), config_of(rod_), places_of(rod_)),
      carried_(rod_.payloads.size(), 0) {
  if (rod_.contact)
    for (const Obstacle& obstacle : obstacles(rod_.contact->obstacles)) names_.push_back(obstacle.name);
  surround();
  double base = 0;
  for (const RodSection& section : inputs().rod().sections) {
    bases_.push_back(base);
    base += section.length;
  }
  may_lose_steps_ = inputs().may_lose_steps();
  can_stretch_ = inputs().can_stretch();
  RodStatics statics(inputs().rod());
  statics.stretch_rest(inputs().rest_stretches(0));
  set_lengths(0);
  const Equilibrium rest =
      statics.solve({.displacements = inputs().displacements(0, inputs().nothing_lost())}, inputs().loads(0));
  if (!rest.converged())
    throw SimulationError(fmt::format("the arm has no initial equilibrium: {}", words(rest.end)));
  snapshots_.push_back({0, dynamics_.rest(rest), rotors_at_rest(inputs(), rest.tensions), carried_});
  hand_over(snapshots_.back(), 0);
}

DynamicPlant::~DynamicPlant() = default;

// Builds contact, drag and spring on the current nodes of the rod.
void DynamicPlant::surround() const {
  std::vector<const RodSurroundings*> around;
  if (rod_.contact) around.push_back(&contact_.emplace(dynamics_.chain(), *rod_.contact));
  if (rod_.drag) around.push_back(&drag_.emplace(dynamics_.chain(), *rod_.drag));
  if (grabbed_) around.push_back(&spring_.emplace(dynamics_.chain(), *grabbed_));
  dynamics_.set_surroundings(around.empty() ? nullptr : &surroundings_.emplace(around));
}

// Makes the pushed point a node. States remain valid: nodes in addition to the integration points do not
// change the rod.
void DynamicPlant::grab(const std::optional<RodPlace>& place) const {
  if (place == grabbed_) return;
  std::vector<RodPlace> places = places_of(rod_);
  if (place) places.push_back(*place);
  dynamics_ = RodDynamics(inputs().rod(), config_of(rod_), places);
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
  answers_.clear();
  next_answer_ = 0;
}

void DynamicPlant::advance(double time) {
  forget();
  const long last = static_cast<long>(std::floor(time / step_ + no_time));
  for (long next = snapshots_.back().index + 1; next <= last; ++next) {
    Snapshot then = snapshots_.back();
    {
      const std::lock_guard lock(mutex_);
      go_on(then, time_of(then.index), time_of(next));
      hand_over(then, time_of(next));
      audit(then, time_of(then.index), time_of(next));
    }
    then.index = next;
    snapshots_.push_back(std::move(then));
  }
  const double oldest = time - horizon_ - 2 * step_;
  std::size_t gone = 0;
  while (gone + 1 < snapshots_.size() && time_of(snapshots_[gone + 1].index) < oldest) ++gone;
  snapshots_.erase(snapshots_.begin(), snapshots_.begin() + static_cast<std::ptrdiff_t>(gone));
  inputs().forget_before(oldest);
}

std::vector<double> DynamicPlant::events(double from, double to) const {
  const double margin = no_time * step_;
  std::vector<double> times = inputs().events(from + margin, to - margin);
  for (const ArmRod::Payload& payload : rod_.payloads)
    for (const double time : {payload.from, payload.until})
      if (time > from + margin && time < to - margin) times.push_back(time);
  std::ranges::sort(times);
  const auto same = std::ranges::unique(times);
  times.erase(same.begin(), same.end());
  return times;
}

// Advances from one event to the next.
void DynamicPlant::go_on(Snapshot& at, double from, double to) const {
  grab(grabbed_at(from));
  carry(at.carried);
  for (const double event : events(from, to)) {
    turn(at, from, event);
    hand_over(at, event);
    from = event;
  }
  turn(at, from, to);
}

// Advances in short steps while motors may lose microsteps.
void DynamicPlant::turn(Snapshot& at, double from, double to) const {
  if (!may_lose_steps_) {
    move(at, from, to - from);
    return;
  }
  const auto is_strained = [&](double time) {
    return are_strained(at.rotors, inputs(), at.state.tensions, time);
  };
  if (!is_strained(from)) {
    const Snapshot before = at;
    move(at, from, to - from);
    turn_rotors(at.rotors, inputs(), at.state.tensions, to, to - from);
    if (!is_strained(to)) return;
    at = before;
  }
  const int pieces = static_cast<int>(std::ceil((to - from) / rotor_step * (1 - no_time)));
  for (int i = 0; i < pieces; ++i) {
    const double start = from + i * (to - from) / pieces, end = from + (i + 1) * (to - from) / pieces;
    move(at, start, end - start);
    turn_rotors(at.rotors, inputs(), at.state.tensions, end, end - start);
  }
}

// Steps, in halves of halves if the arm moves so far that it may have passed through an obstacle.
void DynamicPlant::move(Snapshot& at, double from, double h) const {
  constexpr double most_parts = 1024;
  if (!contact_ || h < step_ / most_parts) {
    step(at, from, h);
    return;
  }
  const std::vector<NodeMotion> before = dynamics_.point_motions(at.state);
  Snapshot then = at;
  step(then, from, h);
  if (!contact_->may_have_passed(before, dynamics_.point_motions(then.state))) {
    at = std::move(then);
    return;
  }
  move(at, from, 0.5 * h);
  move(at, from + 0.5 * h, 0.5 * h);
}

void DynamicPlant::step(Snapshot& at, double from, double h) const {
  const double middle = from + h / (1 + rod_.spectral_radius);
  const TendonInput input{.displacements = inputs().displacements(middle, at.rotors.behind)};
  if (can_stretch_) {
    std::vector<double> rates = inputs().rest_stretches(from + h);
    const std::vector<double> before = inputs().rest_stretches(from);
    for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (rates[i] - before[i]) / h;
    dynamics_.stretch_rest(inputs().rest_stretches(middle), rates);
  }
  // A push that moves to another place during this step takes effect from the next step on.
  if (grabbed_) spring_->set(grabbed_at(middle) == grabbed_ ? inputs().spring(middle) : std::nullopt);
  const RodStep step = dynamics_.step(at.state, input, inputs().loads(middle), h);
  if (step.is_anew) ++at.divided;
  if (!step.converged())
    throw SimulationError(fmt::format("at {:.4f} s the motion of the arm cannot be computed: {}", from,
                                      step.problem.empty() ? words(step.end) : step.problem));
  const Eigen::VectorXd& q = at.state.q;
  if (!q.allFinite() || q.cwiseProduct(dynamics_.chain().scales()).cwiseAbs().maxCoeff() >= greatest_strain)
    throw SimulationError(fmt::format(
        "at {:.4f} s the motion of the arm diverges: its actuation or loads are too strong for steps of {} s",
        from, step_));
}

// Sets the sections' lengths and their rates at a time.
void DynamicPlant::set_lengths(double time) const {
  if (!can_stretch_) return;
  const std::vector<double> now = inputs().rest_stretches(time),
                            before = inputs().rest_stretches(std::max(0.0, time - shortly));
  std::vector<double> rates;
  rates.reserve(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) rates.push_back((now[i] - before[i]) / shortly);
  dynamics_.stretch_rest(now, rates);
}

const DynamicPlant::Snapshot& DynamicPlant::snapshot(double time) const {
  std::size_t from = snapshots_.size() - 1;
  while (from > 0 && time_of(snapshots_[from].index) > time + no_time * step_) --from;
  return snapshots_[from];
}

DynamicPlant::Answer* DynamicPlant::answer_at(double time) const {
  const auto found = std::ranges::find(answers_, time, &Answer::time);
  return found == answers_.end() ? nullptr : &*found;
}

DynamicPlant::Snapshot DynamicPlant::at(double time) const {
  const std::lock_guard lock(mutex_);
  if (const Answer* kept = answer_at(time)) return kept->at;
  Snapshot then = snapshot(time);
  const double start = time_of(then.index);
  grab(grabbed_at(start));
  if (time - start > no_time * step_) {
    go_on(then, start, time);
    hand_over(then, time);
  }
  Answer answer{.time = time, .at = then};
  if (answers_.size() < most_answers)
    answers_.push_back(std::move(answer));
  else
    answers_[next_answer_] = std::move(answer);
  next_answer_ = (next_answer_ + 1) % most_answers;
  return then;
}

// Pictures need the shape at many times within a step. A cubic through the shapes and rates at both ends of
// the step is as accurate as the step, and far cheaper than another step to each of these times.
std::optional<Eigen::VectorXd> DynamicPlant::shape_between(double time) const {
  const Snapshot& from = snapshot(time);
  const auto next = static_cast<std::size_t>(&from - snapshots_.data()) + 1;
  const double start = time_of(from.index), part = (time - start) / step_;
  if (part <= no_time) return from.state.q;
  if (next == snapshots_.size() || from.carried != snapshots_[next].carried ||
      !events(start, start + step_).empty())
    return std::nullopt;
  const RodState &a = from.state, &b = snapshots_[next].state;
  const double rest = 1 - part;
  return rest * rest * ((1 + 2 * part) * a.q + part * step_ * a.rate) +
         part * part * ((1 + 2 * rest) * b.q - rest * step_ * b.rate);
}

Backbone DynamicPlant::backbone(double time) const {
  const std::optional<Eigen::VectorXd> between = shape_between(time);
  const Eigen::VectorXd q = between ? *between : at(time).state.q;
  try {
    return tube().backbone(q, inputs().rest_stretches(time));
  } catch (const std::invalid_argument&) {
    throw SimulationError(fmt::format(
        "at {:.4f} s the motion of the arm diverges: its curvature is larger than possible", time));
  }
}

std::vector<double> DynamicPlant::tensions(double time) const { return at(time).state.tensions; }

std::optional<RodEnergy> DynamicPlant::energy(double time) const {
  const Snapshot then = at(time);
  const std::lock_guard lock(mutex_);
  carry(then.carried);
  set_lengths(time);
  return dynamics_.energy(then.state, inputs().loads(time));
}

std::vector<char> DynamicPlant::carried_at(double time) const {
  std::vector<char> carried;
  carried.reserve(rod_.payloads.size());
  for (const ArmRod::Payload& payload : rod_.payloads)
    carried.push_back(payload.from <= time && time < payload.until ? 1 : 0);
  return carried;
}

// Attaches the masses of these payloads to the rod, regardless of its state.
void DynamicPlant::carry(const std::vector<char>& desired) const {
  if (carried_ == desired) return;
  const RodState any = dynamics_.rest();
  for (std::size_t i = 0; i < desired.size(); ++i)
    if (carried_[i] != 0) (void)dynamics_.drop(any, rod_.payloads[i].payload.place, {}, {});
  for (std::size_t i = 0; i < desired.size(); ++i)
    if (desired[i] != 0) (void)dynamics_.pick_up(any, rod_.payloads[i].payload, {}, {});
  carried_ = desired;
}

// Picks up and drops payloads: converts a state with the previous payloads into one with those from now on.
void DynamicPlant::hand_over(Snapshot& at, double time) const {
  const std::vector<char> desired = carried_at(time);
  if (at.carried == desired) return;
  const TendonInput input{.displacements = inputs().displacements(time, at.rotors.behind)};
  const RodLoads& loads = inputs().loads(time);
  set_lengths(time);
  std::vector<char> left = at.carried;
  for (std::size_t i = 0; i < desired.size(); ++i) {
    const RodPlace& place = rod_.payloads[i].payload.place;
    if (left[i] == 0 || desired[i] != 0) continue;
    at.state = dynamics_.drop(at.state, place, input, loads);
    // Everything carried at this place is dropped.
    for (std::size_t k = 0; k < left.size(); ++k) {
      const RodPlace& other = rod_.payloads[k].payload.place;
      if (other.section == place.section && std::abs(other.at - place.at) <= one_place) left[k] = 0;
    }
  }
  for (std::size_t i = 0; i < desired.size(); ++i) {
    if (desired[i] == 0 || left[i] != 0) continue;
    RodPayload payload = rod_.payloads[i].payload;
    if (at.carried[i] != 0) {
      // The payload stays attached, and moves with its place.
      const NodeMotion motion = dynamics_.motion(at.state, payload.place);
      const Eigen::Vector3d p = motion.pose * payload.offset;
      payload.velocity = motion.twist.head<3>() + motion.twist.tail<3>().cross(p);
    }
    at.state = dynamics_.pick_up(at.state, payload, input, loads);
  }
  at.carried = carried_ = desired;
}

// Contacts at a time are queried twice, for the record and for the warning; they are computed once.
std::vector<PlantContact> DynamicPlant::contacts(double time) const {
  if (!contact_) return {};
  const Snapshot then = at(time);
  const std::lock_guard lock(mutex_);
  if (const Answer* kept = answer_at(time); kept != nullptr && kept->contacts) return *kept->contacts;
  carry(then.carried);
  set_lengths(time);
  std::vector<PlantContact> result = found(contact_->find(dynamics_.point_motions(then.state)));
  if (Answer* kept = answer_at(time)) kept->contacts = result;
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
      return fmt::format("the centerline of the arm is inside {}: the contact force is not valid",
                         contact.with);
  // A few are due to impacts.
  constexpr int many = 10;
  const std::lock_guard lock(mutex_);
  if (snapshot(time).divided >= many)
    return fmt::format(
        "steps of {} s are too long for the motion of the arm: dividing them is slow and less accurate; "
        "choose a shorter arm.time_step",
        step_);
  if (snapshot(time).audit.has_grown())
    return fmt::format(
        "the energy of the arm grows although nothing drives it: steps of {} s do not resolve the fastest "
        "modes of its rods; choose a smaller arm.spectral_radius, a shorter arm.time_step, or fewer modes",
        step_);
  return {};
}

}  // namespace flexura
