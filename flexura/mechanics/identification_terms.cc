#include "flexura/mechanics/identification_terms.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

namespace flexura {

std::vector<std::size_t> rubbing_tendons(const Rod& rod, const RodParameter& parameter) {
  std::vector<std::size_t> tendons;
  for (std::size_t i = 0; i < rod.tendons.size(); ++i)
    if (parameter.section.value_or(rod.tendons[i].section) == rod.tendons[i].section) tendons.push_back(i);
  return tendons;
}

namespace identified {

using Eigen::MatrixXd, Eigen::VectorXd;

// A rod at a sample, whose tendons have slid as in the samples before.
class SlidingRod {
 public:
  explicit SlidingRod(RodDynamics& dynamics) : dynamics_(&dynamics) {}
  // Advances to the sample and returns the state with its forces.
  const RodState& go_on(const RodMotionRecordSample& sample, const VectorXd& v, const RodLoads& loads) {
    before_ = now_;
    const RodState state = dynamics_->start(sample.q, v, {.tensions = sample.tensions}, loads, slide(sample));
    now_.emplace(state);
    now_->time = sample.time;
    return *now_;
  }
  [[nodiscard]] RodDynamicsSlopes slopes(const RodMotionRecordSample& sample, const RodLoads& loads) {
    return dynamics_->slopes(now_.value(), {.tensions = sample.tensions}, loads, slide(sample));
  }

 private:
  const RodSlide* slide(const RodMotionRecordSample& sample) {
    if (!before_ || before_->friction.empty()) return nullptr;
    slide_ = {before_->friction, sample.time - before_->time};
    return &slide_;
  }
  RodDynamics* dynamics_;
  std::optional<RodState> before_ = {}, now_ = {};
  RodSlide slide_ = {};
};

// What a parameter multiplies: part of the stiffness or damping, or rods with more and less friction.
// Neither: the mass.
struct ParameterPart {
  MatrixXd stiffness = {}, damping = {};
  std::unique_ptr<RodDynamics> more = {}, less = {};
  std::vector<SlidingRod> sliding = {};    // For these two rods.
  double coefficient = 0, difference = 0;  // Friction coefficient, and the difference between the two rods.
};

// Parts of the forces that depend on parameters, and those of the given rod.
struct Shares {
  Shares(const RodDynamics& dynamics, const std::vector<RodParameter>& parameters);
  MatrixXd stiffness, damping;  // Of the given rod.
  std::vector<ParameterPart> parts;
  VectorXd nominal;
  bool has_mass = false;
};

}  // namespace identified

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using identified::ParameterPart, identified::Shares, identified::SlidingRod;

std::array<bool, 6> strains_of(RodParameter::Kind kind) {
  switch (kind) {
    case RodParameter::Kind::shear:
      return {true, true, false, false, false, false};
    case RodParameter::Kind::stretch:
      return {false, false, true, false, false, false};
    case RodParameter::Kind::bends:
      return {false, false, false, true, true, false};
    case RodParameter::Kind::twist:
      return {false, false, false, false, false, true};
    case RodParameter::Kind::stiffness:
    case RodParameter::Kind::damping:
      return {true, true, true, true, true, true};
    case RodParameter::Kind::mass:
    case RodParameter::Kind::friction:
      break;
  }
  return {};
}

// Returns the modes that a parameter affects.
std::vector<Index> parameter_modes(const RodChain& chain, const RodParameter& parameter) {
  if (parameter.section && *parameter.section >= chain.rod().sections.size())
    throw std::invalid_argument("a parameter refers to a section that the rod does not have");
  if (parameter.kind == RodParameter::Kind::mass && parameter.section)
    throw std::invalid_argument("the mass is a parameter of the whole rod: expected no section");
  std::vector<Index> modes;
  const std::array<bool, 6> strains = strains_of(parameter.kind);
  for (std::size_t i = 0; i < chain.elements().size(); ++i) {
    const RodElement& element = chain.elements()[i];
    if (parameter.section && *parameter.section != element.part().section) continue;
    element.grid().for_modes([&](int strain, int mode) {
      if (strains[static_cast<std::size_t>(strain)]) modes.push_back(chain.first(i) + mode);
    });
  }
  return modes;
}

MatrixXd part_of(const MatrixXd& whole, const std::vector<Index>& modes) {
  MatrixXd part = MatrixXd::Zero(whole.rows(), whole.cols());
  part(modes, modes) = whole(modes, modes);
  return part;
}

void set_friction(ParameterPart& part, const RodChain& chain, const RodParameter& parameter,
                  std::vector<char>& taken) {
  constexpr double step = 1e-3;
  if (parameter.section && *parameter.section >= chain.rod().sections.size())
    throw std::invalid_argument("a parameter refers to a section that the rod does not have");
  const std::vector<std::size_t> tendons = rubbing_tendons(chain.rod(), parameter);
  if (!tendons.empty()) part.coefficient = chain.rod().tendons[tendons.front()].friction;
  Rod more = chain.rod(), less = chain.rod();
  const double low = std::max(0.0, part.coefficient - step), high = low + 2 * step;
  part.difference = high - low;
  for (const std::size_t i : tendons) {
    if (std::exchange(taken[i], char{1}) != 0) throw std::invalid_argument("parameters that overlap");
    more.tendons[i].friction = high;
    less.tendons[i].friction = low;
  }
  part.more = std::make_unique<RodDynamics>(std::move(more));
  part.less = std::make_unique<RodDynamics>(std::move(less));
  part.sliding = {SlidingRod(*part.more), SlidingRod(*part.less)};
}

// Returns the derivative of the forces by a friction coefficient.
IdentificationTerm friction_term(ParameterPart& part, const RodMotionRecordSample& sample, const VectorXd& v,
                                 const RodLoads& loads, bool with_slopes) {
  SlidingRod &more = part.sliding[0], &less = part.sliding[1];
  const VectorXd most = more.go_on(sample, v, loads).force, least = less.go_on(sample, v, loads).force;
  IdentificationTerm term{.bump = (most - least) / part.difference, .slope = VectorXd::Zero(v.size())};
  if (!with_slopes) return term;
  const RodDynamicsSlopes by_more = more.slopes(sample, loads), by_less = less.slopes(sample, loads);
  term.bump_by_q = (by_more.force_by_q - by_less.force_by_q) / part.difference;
  term.bump_by_v = (by_more.force_by_v - by_less.force_by_v) / part.difference;
  term.slope_by_q = term.slope_by_v = MatrixXd::Zero(v.size(), v.size());
  return term;
}

// Computes to += factor from.
void add_term(IdentificationTerm& to, const IdentificationTerm& from, double factor, bool with_slopes) {
  to.bump += factor * from.bump;
  to.slope += factor * from.slope;
  if (!with_slopes) return;
  to.bump_by_q += factor * from.bump_by_q;
  to.bump_by_v += factor * from.bump_by_v;
  to.slope_by_q += factor * from.slope_by_q;
  to.slope_by_v += factor * from.slope_by_v;
}

}  // namespace

identified::Shares::Shares(const RodDynamics& dynamics, const std::vector<RodParameter>& parameters)
    : stiffness(dynamics.stiffness_matrix()), damping(dynamics.damping_matrix()) {
  const Index n = stiffness.rows();
  const MatrixXd K = stiffness, D = damping;
  std::vector<char> stiffness_taken(static_cast<std::size_t>(n), 0), damping_taken = stiffness_taken;
  nominal = VectorXd::Ones(static_cast<Index>(parameters.size()));
  std::vector<char> rubbing_taken(dynamics.chain().tendons(), 0);
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    ParameterPart& part = parts.emplace_back();
    if (parameters[g].kind == RodParameter::Kind::friction) {
      set_friction(part, dynamics.chain(), parameters[g], rubbing_taken);
      nominal[static_cast<Index>(g)] = part.coefficient;
      continue;
    }
    const std::vector<Index> modes = parameter_modes(dynamics.chain(), parameters[g]);
    if (parameters[g].kind == RodParameter::Kind::mass) {
      if (has_mass) throw std::invalid_argument("parameters that overlap");
      has_mass = true;
      continue;
    }
    const bool is_damping = parameters[g].kind == RodParameter::Kind::damping;
    std::vector<char>& taken = is_damping ? damping_taken : stiffness_taken;
    double time = 0;
    for (const Index mode : modes) {
      if (std::exchange(taken[static_cast<std::size_t>(mode)], char{1}) != 0)
        throw std::invalid_argument("parameters that overlap");
      time += D(mode, mode) / K(mode, mode) / static_cast<double>(modes.size());
    }
    if (is_damping) {
      nominal[static_cast<Index>(g)] = time;
      damping -= part_of(D, modes);
    } else {
      stiffness -= part_of(K, modes);
    }
    (is_damping ? part.damping : part.stiffness) = part_of(K, modes);
  }
}

struct IdentificationTerms::Parts {
  Parts(RodDynamics& given, const std::vector<RodParameter>& parameters)
      : dynamics(given), sliding(given), shares(given, parameters) {}
  RodDynamics& dynamics;
  SlidingRod sliding;
  Shares shares;
};

IdentificationTerms::IdentificationTerms(RodDynamics& dynamics, const std::vector<RodParameter>& parameters)
    : parts_(std::make_unique<Parts>(dynamics, parameters)) {}
IdentificationTerms::~IdentificationTerms() = default;

const VectorXd& IdentificationTerms::nominal() const { return parts_->shares.nominal; }

std::vector<IdentificationTerm> IdentificationTerms::at(const RodMotionRecordSample& sample,
                                                        const VectorXd& v, const RodLoads& loads,
                                                        bool with_slopes) {
  RodDynamics& dynamics = parts_->dynamics;
  SlidingRod& sliding = parts_->sliding;
  Shares& shares = parts_->shares;
  const MatrixXd K = dynamics.stiffness_matrix(), D = dynamics.damping_matrix();
  const RodLoads weight{.gravity = loads.gravity};
  const RodState& all = sliding.go_on(sample, v, loads);
  const RodState heavy = dynamics.start(sample.q, v, {}, weight);
  const VectorXd inner = K * sample.q + D * v;
  IdentificationTerm mass{.bump = heavy.force + inner, .slope = heavy.momentum};
  IdentificationTerm fixed{.bump = all.force - heavy.force - shares.stiffness * sample.q - shares.damping * v,
                           .slope = VectorXd::Zero(v.size())};
  if (with_slopes) {
    const RodDynamicsSlopes by = sliding.slopes(sample, loads);
    const RodDynamicsSlopes heavy_by = dynamics.slopes(heavy, {}, weight);
    mass.bump_by_q = heavy_by.force_by_q + K;
    mass.bump_by_v = heavy_by.force_by_v + D;
    mass.slope_by_q = heavy_by.momentum_by_q;
    mass.slope_by_v = heavy_by.mass;
    fixed.bump_by_q = by.force_by_q - heavy_by.force_by_q - shares.stiffness;
    fixed.bump_by_v = by.force_by_v - heavy_by.force_by_v - shares.damping;
    fixed.slope_by_q = fixed.slope_by_v = MatrixXd::Zero(v.size(), v.size());
  }
  if (!shares.has_mass) add_term(fixed, mass, 1, with_slopes);
  std::vector<IdentificationTerm> terms = {fixed};
  const MatrixXd none = with_slopes ? MatrixXd::Zero(v.size(), v.size()) : MatrixXd();
  for (ParameterPart& part : shares.parts) {
    if (part.more) {
      terms.push_back(friction_term(part, sample, v, loads, with_slopes));
      add_term(terms.front(), terms.back(), -part.coefficient, with_slopes);
      continue;
    }
    if (part.stiffness.size() == 0 && part.damping.size() == 0) {
      terms.push_back(mass);
      continue;
    }
    IdentificationTerm& term = terms.emplace_back(IdentificationTerm{.slope = VectorXd::Zero(v.size()),
                                                                     .bump_by_q = none,
                                                                     .bump_by_v = none,
                                                                     .slope_by_q = none,
                                                                     .slope_by_v = none});
    const bool is_stiff = part.stiffness.size() > 0;
    const MatrixXd& matrix = is_stiff ? part.stiffness : part.damping;
    term.bump = -(matrix * (is_stiff ? sample.q : v));
    if (with_slopes) (is_stiff ? term.bump_by_q : term.bump_by_v) = -matrix;
  }
  return terms;
}

}  // namespace flexura
