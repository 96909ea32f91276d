#include "flexura/mechanics/statics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/math/dense.h"
#include "flexura/mechanics/complementary.h"
#include "flexura/mechanics/rod_spring.h"

namespace flexura {
namespace {

constexpr int max_descent = 30;
// Slack below this part of the rod's length counts as zero.
constexpr double slack_margin = 1e-12;
// Compliance of tendons given as inextensible, relative to the rod's own.
constexpr double stiff_part = 1e-8;

bool all_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

Equilibrium bad_input(std::string problem) {
  Equilibrium result;
  result.end = StaticsEnd::bad_input;
  result.problem = std::move(problem);
  return result;
}

}  // namespace

const char* words(StaticsEnd end) {
  switch (end) {
    case StaticsEnd::converged:
      return "converged";
    case StaticsEnd::bad_input:
      return "bad input";
    case StaticsEnd::no_equilibrium:
      return "no equilibrium found while the load increased from zero";
    case StaticsEnd::disks_meet:
      return "no equilibrium: the tendons pull two guide disks together";
    case StaticsEnd::out_of_steps:
      break;
  }
  return "out of steps";
}

RodStatics::RodStatics(Rod rod, std::span<const RodPlace> places) : chain_(std::move(rod), places) {
  const auto count = static_cast<Eigen::Index>(chain_.tendons());
  pulls_.resize(chain_.tendons());
  taut_.resize(chain_.tendons());
  newton_ = tangent_ = {Eigen::VectorXd::Zero(chain_.size()), Eigen::VectorXd::Zero(count)};
  chain_.balance(newton_.q, pulls_, {}, 0);
  rest_lengths_.assign(chain_.tendon_lengths().begin(), chain_.tendon_lengths().end());
  if (count == 0) return;
  // An unmeasurably small part of the undeformed rod's compliance to its tendons.
  solved_ = chain_.pull_slopes();
  double give = 0;
  if (chain_.size() > 0 && chain_.factor()) {
    chain_.solve(solved_);
    give = (chain_.length_slopes().transpose() * solved_).diagonal().cwiseAbs().maxCoeff();
  }
  give_ = give > 0 ? give : chain_.rod().length();
  least_compliance_ = stiff_part * give_;
}

std::string RodStatics::input_problem() const {
  const auto count = chain_.tendons();
  const auto &tensions = input_.tensions, &displacements = input_.displacements;
  if (!tensions.empty() && !displacements.empty())
    return "both tensions and displacements are given: expected only one of them";
  for (const auto& [name, list] :
       {std::pair{"tensions", &tensions}, std::pair{"displacements", &displacements}}) {
    if (!list->empty() && list->size() != count)
      return fmt::format("{} {} given: expected {}, one per tendon", list->size(), name, count);
    if (!all_finite(*list)) return fmt::format("{} must be finite", name);
  }
  if (std::ranges::any_of(tensions, [](double tension) { return tension < 0; }))
    return "a tension is below 0, but tendons cannot push";
  if (!loads_.gravity.allFinite() || !loads_.per_length.allFinite())
    return "gravity and loads must be finite";
  for (const EndLoad& end : loads_.ends) {
    if (!end.force.allFinite() || !end.moment.allFinite()) return "loads must be finite";
    if (end.section >= chain_.rod().sections.size())
      return "a load acts on a section that the rod does not have";
  }
  for (const PointSpring& spring : loads_.springs) {
    if (std::string problem = spring_problem(spring); !problem.empty()) return problem;
    if (spring.section >= chain_.rod().sections.size())
      return "a spring acts on a section that the rod does not have";
  }
  return "";
}

double RodStatics::measure(const Unknowns& change) const {
  return change.q.size() > 0 ? change.q.cwiseProduct(chain_.scales()).cwiseAbs().maxCoeff() : 0;
}

bool RodStatics::linearize(const Unknowns& at, double share) {
  ++iterations_;
  const std::size_t count = pulls_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (by_displacement_)
      pulls_[i] = at.tensions[static_cast<Eigen::Index>(i)];
    else
      pulls_[i] = input_.tensions.empty() ? 0 : share * input_.tensions[i];
  }
  chain_.balance(at.q, pulls_, loads_, share);
  if (!chain_.residual().allFinite() || !chain_.factor()) return false;
  negative_ = chain_.negative_count();

  const auto tendons = static_cast<Eigen::Index>(count);
  solved_.resize(chain_.size(), 2 + (by_displacement_ ? tendons : 0));
  solved_.col(0) = -chain_.residual();
  solved_.col(1) = -chain_.load_slope();
  if (by_displacement_) {
    // Uses the residual without tendons: their tensions are solved anew.
    solved_.col(0) += chain_.pull_slopes() * at.tensions;
    solved_.rightCols(tendons) = -chain_.pull_slopes();
  } else if (!input_.tensions.empty()) {
    for (std::size_t i = 0; i < count; ++i)
      solved_.col(1) -= input_.tensions[i] * chain_.pull_slopes().col(static_cast<Eigen::Index>(i));
  }
  chain_.solve(solved_);
  newton_.q = solved_.col(0);
  tangent_.q = solved_.col(1);
  newton_.tensions.setZero(tendons);
  tangent_.tensions.setZero(tendons);
  if (by_displacement_ && count > 0 && !find_tensions(at, share)) return false;
  return newton_.q.allFinite() && newton_.tensions.allFinite() && tangent_.q.allFinite();
}

// Tendon lengths depend on shape and tensions. To first order a tendon is too long by excess - give tensions.
// It is slack, or it has the length of its displacement and pulls.
bool RodStatics::find_tensions(const Unknowns& at, double share) {
  const auto tendons = static_cast<Eigen::Index>(pulls_.size());
  const auto answers = solved_.rightCols(tendons);
  Complementary problem{.matrix = -chain_.length_slopes().transpose() * answers, .rhs = {}, .kinds = {}};
  problem.rhs = chain_.tendon_lengths() + chain_.length_slopes().transpose() * solved_.col(0);
  Eigen::VectorXd by_share = chain_.length_slopes().transpose() * solved_.col(1);
  for (Eigen::Index i = 0; i < tendons; ++i) {
    const auto tendon = static_cast<std::size_t>(i);
    problem.matrix(i, i) += compliance(tendon);
    problem.rhs[i] += share * input_.displacements[tendon] - rest_lengths_[tendon];
    by_share[i] += input_.displacements[tendon];
  }
  problem.kinds.assign(pulls_.size(), Complementary::Kind::at_least_0);
  const double rounding = slack_margin * chain_.rod().length();
  const std::optional<Eigen::VectorXd> found = problem.solve(taut_, rounding);
  if (!found) return false;
  const Eigen::VectorXd& tensions = *found;
  newton_.tensions = tensions - at.tensions;
  newton_.q += answers * tensions;

  // Derivative by the load: taut tendons stay taut; those that are just taut may begin to pull.
  const Eigen::VectorXd slack = problem.matrix * tensions - problem.rhs;
  std::vector<Eigen::Index> pulling;
  for (Eigen::Index i = 0; i < tendons; ++i) {
    Complementary::Kind& kind = problem.kinds[static_cast<std::size_t>(i)];
    if (tensions[i] > 0) {
      kind = Complementary::Kind::free;
      pulling.push_back(i);
    } else if (slack[i] > rounding) {
      kind = Complementary::Kind::none;
    }
  }
  problem.rhs = by_share;
  std::vector<char> growing(pulls_.size(), 0);
  // Without a solution, the path continues as if no tendon became taut.
  tangent_.tensions = problem.solve(growing, rounding).value_or(Eigen::VectorXd::Zero(tendons));
  tangent_.q += answers * tangent_.tensions;

  if (pulling.empty()) return true;
  const Eigen::MatrixXd give = problem.matrix(pulling, pulling);
  const SymmetricEigen eigen = symmetric_eigen(0.5 * (give + give.transpose()));
  negative_ = chain_.negative_count(static_cast<int>((eigen.values.array() < 0).count()));
  return true;
}

// Redundant tendons share their load by their small compliance.
double RodStatics::compliance(std::size_t tendon) const {
  return std::max(chain_.rod().tendons[tendon].compliance, least_compliance_);
}

RodStatics::Descent RodStatics::descend(Unknowns& at, double share) {
  Descent descent;
  double before = 0;
  int changes = 0;
  for (int step = 0; step < max_descent; ++step) {
    const std::vector<char> taut = taut_;
    if (!linearize(at, share)) return descent;
    if (step > 0 && taut_ != taut && ++changes <= max_descent / 2) before = 0;
    const double size = measure(newton_);
    if (before > 0 && size > contraction * before && size > settled_step) return descent;
    at.q += newton_.q;
    at.tensions += newton_.tensions;
    descent.negative = negative_;
    descent.always_stable = descent.always_stable && negative_ == 0;
    // The next step: it falls with the square of this one; under friction, by the same factor as this one.
    const double factor = before > 0 ? size / before : 1;
    const double next = chain_.has_friction() ? size * factor : size * factor * factor;
    if (size <= settled_step || next <= settled_step * 1e-2) {
      descent.settled = true;
      return descent;
    }
    before = size;
  }
  return descent;
}

// Returns whether no part of the rod is turned inside out.
bool RodStatics::has_positive_stretch() const {
  return std::ranges::all_of(chain_.elements(), [](const RodElement& element) {
    return std::ranges::all_of(element.strains(), [](const Vector6d& strain) { return strain[2] > 0; });
  });
}

void RodStatics::finish(Equilibrium& result, const Unknowns& at, const Descent& descent) {
  is_solved_ = descent.settled;
  at_ = at.q;
  if (is_solved_) {
    result.end = StaticsEnd::converged;
    result.stable = descent.negative == 0;
  }
  result.q = at.q;
  for (std::size_t i = 0; i < pulls_.size(); ++i) {
    if (by_displacement_)
      pulls_[i] = at.tensions[static_cast<Eigen::Index>(i)];
    else
      pulls_[i] = input_.tensions.empty() ? 0 : input_.tensions[i];
  }
  chain_.balance(at.q, pulls_, loads_, 1);
  // Disks cannot pass through each other, even where Newton's method ends.
  if (is_solved_ && chain_.disks_meet()) {
    is_solved_ = result.stable = false;
    result.end = StaticsEnd::disks_meet;
  }
  chain_.place(at.q);
  result.tensions = pulls_;
  result.tendon_lengths.assign(chain_.tendon_lengths().begin(), chain_.tendon_lengths().end());
  result.displacements.clear();
  for (std::size_t i = 0; i < pulls_.size(); ++i) {
    result.tensions[i] += 0.0;  // No negative zeros.
    result.displacements.push_back(rest_lengths_[i] - result.tendon_lengths[i] + compliance(i) * pulls_[i]);
  }
  result.strain_energy = chain_.strain_energy();
  result.tip = chain_.tip();
  if (is_solved_) result.coarse_section = chain_.coarse_section();
  result.iterations = iterations_;
}

Equilibrium RodStatics::solve_from(const Unknowns& start, bool is_cold) {
  Equilibrium result;
  const Unknowns rest{Eigen::VectorXd::Zero(start.q.size()), Eigen::VectorXd::Zero(start.tensions.size())};
  iterations_ = 0;
  const std::vector<char> taut = taut_;
  Unknowns at = start, last_stable = rest;
  Descent descent = descend(at, 1);
  bool found = descent.settled && descent.always_stable;
  if (!found) {
    taut_ = taut;
    if (!is_cold) {
      std::ranges::fill(taut_, char{1});
      at = rest;
      descent = descend(at, 1);
      found = descent.settled && descent.always_stable;
    }
    if (!found) {
      std::ranges::fill(taut_, char{1});
      at = rest;
      found = follow(result, at, last_stable);
      descent = {.settled = found, .negative = negative_};
    }
  }
  // A rod cannot pass through itself.
  if (found && !has_positive_stretch()) {
    found = false;
    result.end = StaticsEnd::no_equilibrium;
  }
  if (!found) {
    // Descends from the given start, else from the last stable shape of the path.
    Unknowns falling = start;
    found = !is_cold && fall(falling, descent);
    if (!found) {
      falling = last_stable;
      found = fall(falling, descent);
    }
    if (!found && chain_.disks_meet()) result.end = StaticsEnd::disks_meet;
    if (found) {
      at = falling;
      // Strong friction alone stops Newton's method, on a path that neither turns nor branches.
      if (!chain_.has_friction()) result.snapped = result.ambiguous = true;
    }
  }
  descent.settled = found;
  finish(result, at, descent);
  return result;
}

void RodStatics::stretch_rest(std::span<const double> factors) {
  chain_.stretch_rest(factors);
  is_solved_ = false;
}

Equilibrium RodStatics::solve(const TendonInput& tendons, const RodLoads& loads) {
  return solve(tendons, loads, {});
}

std::string RodStatics::take(const TendonInput& tendons, const RodLoads& loads) {
  input_ = tendons;
  loads_ = loads;
  by_displacement_ = !tendons.displacements.empty();
  is_solved_ = false;
  return input_problem();
}

bool RodStatics::is_start(const Equilibrium& near) const {
  return near.q.size() == chain_.size() && near.tensions.size() == taut_.size() && near.converged();
}

RodStatics::Unknowns RodStatics::start_at(const Equilibrium& near) {
  std::ranges::fill(taut_, char{1});
  Unknowns start{Eigen::VectorXd::Zero(chain_.size()),
                 Eigen::VectorXd::Zero(static_cast<Eigen::Index>(taut_.size()))};
  if (!is_start(near)) return start;
  start.q = near.q;
  for (std::size_t i = 0; i < taut_.size() && by_displacement_; ++i) {
    start.tensions[static_cast<Eigen::Index>(i)] = near.tensions[i];
    taut_[i] = near.tensions[i] > 0 ? 1 : 0;
  }
  return start;
}

Equilibrium RodStatics::solve(const TendonInput& tendons, const RodLoads& loads, const Equilibrium& near) {
  if (std::string problem = take(tendons, loads); !problem.empty()) return bad_input(std::move(problem));
  return solve_from(start_at(near), !is_start(near));
}

}  // namespace flexura
