#include "flexura/mechanics/dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "flexura/mechanics/dynamics_work.h"

namespace flexura {
namespace {

// Compliance of tendons given as inextensible, relative to the rod's own (RodStatics).
constexpr double least_give = 1e-8;

bool every_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

void require_dynamics(const Rod& rod, const RodDynamicsConfig& config) {
  const bool is_share = config.spectral_radius >= 0 && config.spectral_radius <= 1;
  if (!is_share) throw std::invalid_argument("the spectral radius must be from 0 to 1");
  if (!(config.tolerance > 0) || config.most_iterations < 1 || config.most_pieces < 1)
    throw std::invalid_argument("the tolerance must be above 0, iterations and pieces at least 1");
  for (std::size_t i = 0; i < rod.sections.size(); ++i) {
    const RodSection& section = rod.sections[i];
    if (!(section.mass_per_length_at(0) > 0) || !(section.mass_per_length_at(1) > 0))
      throw std::invalid_argument(
          fmt::format("section {}: a rod in motion must have a density or a mass per length", i + 1));
    double most = 0;
    for (const double t : {0.0, 1.0})
      most = std::max({most, section.mass_per_length_at(t), section.stiffness_at(t).maxCoeff(),
                       section.damping_at(t).maxCoeff()});
    for (const PointMass& mass : section.masses) most = std::max({most, mass.mass, mass.offset.norm()});
    if (!(most < 1e100))
      throw std::invalid_argument(
          fmt::format("section {}: a mass, a stiffness or a damping of more than 1e100", i + 1));
    if (!config.rotary_inertia && section.modes.counts()[5] > 0)
      throw std::invalid_argument(
          fmt::format("section {}: without rotary inertia a rod must not twist", i + 1));
  }
  if (!(config.friction_grip > 0) || !std::isfinite(config.friction_grip))
    throw std::invalid_argument("the grip of friction must be above 0");
}

}  // namespace

const char* words(DynamicsEnd end) {
  switch (end) {
    case DynamicsEnd::converged:
      return "converged";
    case DynamicsEnd::bad_input:
      return "bad input";
    case DynamicsEnd::did_not_converge:
      break;
  }
  return "the step did not converge because it is too long";
}

RodDynamics::Work::Work(Rod rod, const RodDynamicsConfig& given, std::span<const RodPlace> places)
    : config(given),
      scheme(given.spectral_radius),
      chain(std::move(rod), places),
      layout(chain, given.rotary_inertia),
      motion(layout),
      matrix(layout) {
  require_dynamics(chain.rod(), config);
  const Eigen::Index n = chain.size();
  const auto count = static_cast<Eigen::Index>(chain.tendons());
  for (Eigen::VectorXd* vector : {&velocity, &q_from_, &p_from_, &q_, &momentum_, &force_, &change_, &left_})
    vector->setZero(n);
  length_slopes_.setZero(n, count);
  pull_slopes_.setZero(n, count);
  answers_.setZero(n, count);
  give_.setZero(count, count);
  pivot_.setZero(count, count);
  for (Eigen::VectorXd* vector : {&lengths_, &desired_, &found_, &pull_change_}) vector->setZero(count);
  taut_.resize(chain.tendons());
  tensions.resize(chain.tendons());

  double mass = 0;
  for (const RodLayout::Body& body : layout.bodies) mass += body.mass;
  turning_inertia_ = mass * chain.rod().length() * chain.rod().length() / 3;

  chain.balance(velocity, tensions, {}, 0);
  rest_lengths.assign(chain.tendon_lengths().begin(), chain.tendon_lengths().end());
  double give = 0;
  Eigen::VectorXd gives = Eigen::VectorXd::Zero(count);
  if (count > 0 && n > 0 && chain.factor()) {
    answers_ = chain.pull_slopes();
    chain.solve(answers_);
    gives = (chain.length_slopes().transpose() * answers_).diagonal().cwiseAbs();
    give = gives.maxCoeff();
  }
  if (rubs()) find_grip(gives);
  const double least = give > 0 ? least_give * give : least_give * chain.rod().length();
  for (const TendonRoute& tendon : chain.rod().tendons)
    compliance.push_back(std::max(tendon.compliance, least));
}

// Sets bristle stiffnesses from the rod's compliance to each tendon.
void RodDynamics::Work::find_grip(const Eigen::VectorXd& give) {
  constexpr double least_part = 1e-3;
  const double most = give.maxCoeff() > 0 ? give.maxCoeff() : chain.rod().length();
  grip.assign(layout.pieces, 0.0);
  for (const RodLayout::Rubbing& rub : layout.rubbing) {
    double length = 0;
    for (const RodLayout::Piece& piece : rub.pieces) length += piece.run;
    const double gives = std::max(give[static_cast<Eigen::Index>(rub.tendon)], least_part * most);
    for (std::size_t p = 0; p < rub.pieces.size(); ++p)
      grip[rub.first + p] = config.friction_grip / gives * rub.pieces[p].held / length;
  }
  motion.set_grip(grip);
  // A compliance L^T K^-1 P changes by -L^T K^-1 dK K^-1 P, where P are pulls with friction.
  grip_by_parameters.setZero(give.size(), inner_forces(velocity, velocity).cols());
  if (!(give.maxCoeff() > 0)) return;
  Eigen::MatrixXd by_length = chain.length_slopes();
  chain.solve(by_length);
  for (Eigen::Index i = 0; i < give.size(); ++i) {
    Eigen::Index softest = i;
    if (give[i] < least_part * most) give.maxCoeff(&softest);
    const Eigen::VectorXd shape = answers_.col(softest);
    grip_by_parameters.row(i) = by_length.col(softest).transpose() * inner_forces(shape, velocity) /
                                chain.length_slopes().col(softest).dot(shape);
  }
}

void RodDynamics::Work::hold(const double* before, double time) {
  held_before_ = before;
  slide_time_ = time;
  motion.hold(before, time);
}

std::string RodDynamics::Work::input_problem(const TendonInput& tendons, const RodLoads& loads) const {
  const std::size_t count = chain.tendons();
  if (!tendons.tensions.empty() && !tendons.displacements.empty())
    return "both tensions and displacements are given: expected only one of them";
  const auto list_problem = [&](const char* name, const std::vector<double>& list) -> std::string {
    if (list.empty()) return "";
    if (list.size() != count)
      return fmt::format("{} {} given: expected {}, one per tendon", list.size(), name, count);
    return every_finite(list) ? "" : fmt::format("{} must be finite", name);
  };
  std::string problem = list_problem("tensions", tendons.tensions);
  if (problem.empty()) problem = list_problem("displacements", tendons.displacements);
  if (!problem.empty()) return problem;
  if (std::ranges::any_of(tendons.tensions, [](double tension) { return tension < 0; }))
    return "a tension is below 0, but tendons cannot push";
  if (!loads.gravity.allFinite() || !loads.per_length.allFinite()) return "gravity and loads must be finite";
  for (const EndLoad& end : loads.ends) {
    if (!end.force.allFinite() || !end.moment.allFinite()) return "loads must be finite";
    if (end.section >= chain.rod().sections.size())
      return "a load acts on a section that the rod does not have";
  }
  if (!loads.springs.empty())
    return "the loads of a moving rod cannot have springs: expected them as surroundings (RodSpring)";
  return "";
}

void RodDynamics::Work::set_tensions(const TendonInput& tendons) {
  std::ranges::fill(tensions, 0.0);
  if (!tendons.tensions.empty()) std::ranges::copy(tendons.tensions, tensions.begin());
  if (tendons.displacements.empty()) return;
  motion.find_lengths(lengths_.data());
  for (std::size_t i = 0; i < tensions.size(); ++i) {
    const double excess = lengths_[static_cast<Eigen::Index>(i)] - rest_lengths[i] + tendons.displacements[i];
    tensions[i] = std::max(0.0, excess / compliance[i]);
  }
}

bool RodDynamics::Work::find_velocity(const RodState& state) {
  velocity.setZero();
  motion.place(state.q.data(), velocity.data());
  matrix.find_columns(motion);
  if (!matrix.factor(motion, {}, nullptr, false)) return false;
  velocity = state.momentum;
  if (layout.is_driven) {
    // Subtracts momentum of motion at constant modes (driven lengths).
    left_ = velocity;
    motion.pull({}, std::vector<double>(tensions.size(), 0.0).data(), nullptr);
    motion.balance(momentum_.data(), force_.data());
    velocity = left_ - momentum_;
  }
  matrix.solve(velocity.data());
  return true;
}

void RodDynamics::Work::set_surroundings(const RodSurroundings* given) {
  surroundings = given;
  differential_.reset();
  motion.set_points(nullptr);
  points.reset();
  if (given == nullptr || given->points().empty()) return;
  points = std::make_unique<RodPoints>(layout, given->points());
  motion.set_points(points.get());
}

void RodDynamics::Work::set_forces(RodState& state, const Eigen::VectorXd& v, const TendonInput& tendons,
                                   const RodLoads& loads) {
  motion.place(state.q.data(), v.data());
  set_tensions(tendons);
  motion.pull(loads, tensions.data(), surroundings);
  motion.balance(state.momentum.data(), state.force.data());
  state.tensions = tensions;
  state.friction = motion.frictions();
}

RodDynamics::RodDynamics(Rod rod, const RodDynamicsConfig& config, std::span<const RodPlace> places)
    : work_(std::make_unique<Work>(std::move(rod), config, places)) {}
RodDynamics::~RodDynamics() = default;
RodDynamics::RodDynamics(RodDynamics&&) noexcept = default;
RodDynamics& RodDynamics::operator=(RodDynamics&&) noexcept = default;

void RodDynamics::set_surroundings(const RodSurroundings* surroundings) {
  work_->set_surroundings(surroundings);
}
void RodDynamics::stretch_rest(std::span<const double> factors, std::span<const double> rates) {
  const std::size_t count = work_->chain.rod().sections.size();
  if (factors.size() != count || rates.size() != count)
    throw std::invalid_argument("expected a factor on the length of each section, and its rate");
  constexpr double most_rate = 1e100;  // Energies of larger ones are not finite.
  for (std::size_t i = 0; i < count; ++i)
    if (!(factors[i] > 0) || !std::isfinite(factors[i]) || !(std::abs(rates[i]) < most_rate))
      throw std::invalid_argument("expected factors above 0 on the lengths of sections, and finite rates");
  work_->layout.stretch_rest(factors, rates);
}
const RodChain& RodDynamics::chain() const { return work_->chain; }

RodState RodDynamics::rest() const {
  RodState state;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(work_->chain.size());
  state.q = state.momentum = state.rate = state.force = none;
  state.middle = {none, none, none};
  state.tensions.assign(work_->chain.tendons(), 0.0);
  state.friction.assign(work_->layout.pieces, 0.0);
  return state;
}

RodState RodDynamics::rest(const Equilibrium& at) const {
  RodState state = rest();
  if (at.q.size() != state.q.size() || at.tensions.size() != state.tensions.size())
    throw std::invalid_argument("the equilibrium belongs to another rod");
  state.q = at.q;
  state.tensions = at.tensions;
  if (!work_->rubs()) return state;
  // Friction is at its limit.
  Work& work = *work_;
  work.velocity.setZero();
  work.motion.place(state.q.data(), work.velocity.data());
  const std::vector<double> most(work.layout.pieces, std::numeric_limits<double>::max());
  work.hold(most.data(), 0);
  work.motion.pull({}, state.tensions.data(), nullptr);
  state.friction = work.motion.frictions();
  work.hold(nullptr, 0);
  return state;
}

RodState RodDynamics::start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const TendonInput& tendons,
                            const RodLoads& loads, const RodSlide* slide) {
  RodState state = rest();
  if (slide != nullptr && slide->friction.size() != state.friction.size())
    throw std::invalid_argument("the friction belongs to another rod");
  if (q.size() != state.q.size() || v.size() != state.q.size())
    throw std::invalid_argument(fmt::format("expected {} modes and rates", state.q.size()));
  if (!q.allFinite() || !v.allFinite()) throw std::invalid_argument("modes and rates must be finite");
  const std::string problem = work_->input_problem(tendons, loads);
  if (!problem.empty()) throw std::invalid_argument(problem);
  state.q = q;
  state.rate = v;
  if (slide != nullptr)
    work_->hold(slide->friction.data(), slide->time);
  else
    work_->hold(nullptr, Work::has_slid);
  work_->set_forces(state, v, tendons, loads);
  if (!Work::is_of_this_world(state.momentum) || !Work::is_of_this_world(state.force) ||
      !Work::is_of_this_world(q) || !Work::is_of_this_world(v))
    throw std::invalid_argument("motion and forces must be finite and at most 1e100");
  return state;
}

RodStep RodDynamics::step(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h) {
  std::string problem = work_->input_problem(tendons, loads);
  if (!(h > 0) || !std::isfinite(h)) problem = "a step must be above 0 and finite";
  if (state.q.size() != work_->chain.size() || state.momentum.size() != work_->chain.size())
    problem = "the state belongs to another rod";
  else if (state.friction.size() != work_->layout.pieces)
    problem = "the state lacks the friction of the tendons";
  else if (!state.q.allFinite() || !state.momentum.allFinite())
    problem = "the state must be finite";
  if (!problem.empty()) return {.end = DynamicsEnd::bad_input, .problem = problem};
  return work_->step(state, tendons, loads, h);
}

}  // namespace flexura
