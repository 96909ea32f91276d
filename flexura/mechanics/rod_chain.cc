#include "flexura/mechanics/rod_chain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

bool is_none(const RodLoads& loads) {
  return loads.gravity.isZero(0) && loads.per_length.isZero(0) && loads.ends.empty() && loads.springs.empty();
}

// Returns whether loads are the gradient of an energy.
bool is_conservative(const RodLoads& loads) {
  return std::ranges::all_of(loads.ends,
                             [](const EndLoad& end) { return !end.following && end.moment.isZero(0); });
}

// Sets as many nodes as winding tendons need, by default.
void set_nodes(RodSection& section, const std::vector<TendonRoute>& tendons, std::size_t index) {
  if (section.nodes != 0) return;
  double turns = 0;
  for (const TendonRoute& tendon : tendons)
    if (tendon.section >= index)
      turns = std::max(turns, std::abs(tendon.angle_slope) * section.length / (2 * std::numbers::pi));
  const auto counts = section.modes.counts();
  constexpr int least = 5, most = 64, a_turn = 8;
  const double wound = std::min(a_turn * turns, static_cast<double>(most));
  section.nodes =
      std::min(most, std::max(least, *std::ranges::max_element(counts) + 2) + static_cast<int>(wound));
}

bool is_part(double at) { return at >= 0 && at <= 1; }

// Returns the sign of the determinant, whose value may exceed the range of doubles.
bool is_negative(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) {
  const auto below = (lu.matrixLU().diagonal().array() < 0).count();
  return (lu.permutationP().determinant() < 0) != (below % 2 != 0);
}

}  // namespace

RodChain::RodChain(Rod rod, std::span<const RodPlace> places) : rod_(std::move(rod)) {
  const std::vector<std::string> problems = rod_problems(rod_);
  if (!problems.empty()) throw std::invalid_argument(fmt::format("{}", fmt::join(problems, "; ")));
  for (const RodPlace& place : places)
    if (place.section >= rod_.sections.size() || !is_part(place.at))
      throw std::invalid_argument("the place is outside the rod");
  std::vector<double> at;
  for (RodPart& part : parts_of(rod_)) {
    at.clear();
    set_nodes(part.rod, rod_.tendons, part.section);
    for (const RodPlace& place : places)
      if (part.holds(place)) at.push_back(part.within(place.at));
    const RodElement& element = elements_.emplace_back(std::move(part), rod_.tendons, at);
    first_.push_back(size_);
    size_ += element.size();
    has_chords_ = has_chords_ || element.has_chords();
  }
  scales_.setOnes(size_);
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const RodGrid& grid = elements_[i].grid();
    for (std::size_t c = 3; c < 6; ++c)
      scales_.segment(first_[i] + grid.first[c], grid.count[c])
          .setConstant(rod_.sections[elements_[i].part().section].length);
  }
  residual_.setZero(size_);
  load_slope_.setZero(size_);
  const auto count = static_cast<Eigen::Index>(tendons());
  lengths_.setZero(count);
  slopes_.setZero(size_, count);
  pull_slopes_.setZero(size_, count);
  pivots_.resize(elements_.size());
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const auto n = static_cast<Eigen::Index>(elements_[i].size());
    pivots_[i].matrix.setZero(n, n);
    pivots_[i].by_base.setZero(n, 6);
    pivots_[i].wrench_by_modes.setZero(6, n);
  }
}

RodNode RodChain::node_of(const RodPlace& place) const {
  const auto found =
      std::ranges::find_if(elements_, [&](const RodElement& element) { return element.part().holds(place); });
  if (found == elements_.end() || !is_part(place.at))
    throw std::invalid_argument("the place is outside the rod");
  return {static_cast<std::size_t>(found - elements_.begin()),
          found->grid().node_at(found->part().within(place.at))};
}

void RodChain::place(const Eigen::VectorXd& q) {
  Pose X;
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    elements_[i].set_modes(q.segment(first_[i], elements_[i].size()));
    elements_[i].place(X);
    X = elements_[i].poses().back();
  }
}

void RodChain::place_with_columns(const Eigen::VectorXd& q) {
  Pose X;
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    elements_[i].set_modes(q.segment(first_[i], elements_[i].size()));
    elements_[i].place_with_columns(X);
    X = elements_[i].poses().back();
  }
}

void RodChain::stretch_rest(std::span<const double> factors) {
  if (factors.size() != rod_.sections.size())
    throw std::invalid_argument("expected a factor on the length of each section");
  for (const double factor : factors)
    if (!(factor > 0) || !std::isfinite(factor))
      throw std::invalid_argument("expected factors above 0 on the lengths of sections");
  for (RodElement& element : elements_) element.stretch_rest(factors[element.part().section]);
}

void RodChain::balance(const Eigen::VectorXd& q, std::span<const double> tensions, const RodLoads& loads,
                       double share) {
  is_loaded_ = !is_none(loads);
  is_symmetric_ = is_conservative(loads);
  if (is_loaded_ || has_chords_) {
    place_with_columns(q);
  } else {
    for (std::size_t i = 0; i < elements_.size(); ++i)
      elements_[i].set_modes(q.segment(first_[i], elements_[i].size()));
  }
  for (std::size_t i = 0; i < tendons(); ++i) {
    if (rod_.tendons[i].friction == 0) continue;
    RodElement::Run run;
    const double friction = is_rubbing_ ? rod_.tendons[i].friction : 0;
    for (RodElement& element : elements_) element.rub(i, friction, run);
  }
  lengths_.setZero();
  Vector6d beyond = Vector6d::Zero();
  for (std::size_t i = elements_.size(); i-- > 0;) {
    RodElement& element = elements_[i];
    element.stress(tensions);
    if (is_loaded_) element.load(loads, share, beyond);
    element.add_bending();
    beyond += element.wrench;
    residual_.segment(first_[i], element.size()) = element.residual;
    load_slope_.segment(first_[i], element.size()) = element.by_share;
    lengths_ += element.tendon_lengths;
    pull_slopes_.middleRows(first_[i], element.size()) = element.pull_slopes;
    slopes_.middleRows(first_[i], element.size()) = element.length_slopes;
  }
}

double RodChain::strain_energy() const {
  double sum = 0;
  for (const RodElement& element : elements_) sum += element.strain_energy;
  return sum;
}

std::optional<std::size_t> RodChain::coarse_section() const {
  const auto coarse = std::ranges::find_if(elements_, &RodElement::is_coarse);
  if (coarse == elements_.end()) return {};
  return coarse->part().section;
}

bool RodChain::disks_meet() const {
  constexpr double together = 0.05;
  return has_chords_ && std::ranges::any_of(elements_, [](const RodElement& element) {
           return element.least_chord < together;
         });
}

double RodChain::load_energy(const RodLoads& loads) const {
  double sum = 0;
  for (const RodElement& element : elements_)
    if (is_loaded_) sum += element.load_energy(loads);
  return sum;
}

bool RodChain::has_energy(const RodLoads& loads) const { return is_conservative(loads) && !has_friction(); }

void RodChain::find_stiffness() const {
  if (!stiffness_.empty()) return;
  for (const RodElement& element : elements_) {
    stiffness_.push_back(element.stiffness());
    stiffness_factors_.emplace_back(stiffness_.back());
  }
}

Eigen::VectorXd RodChain::stiffness_times(const Eigen::VectorXd& dq) const {
  find_stiffness();
  Eigen::VectorXd result(size_);
  for (std::size_t i = 0; i < elements_.size(); ++i)
    result.segment(first_[i], elements_[i].size()) =
        stiffness_[i] * dq.segment(first_[i], elements_[i].size());
  return result;
}

double RodChain::stiffness_norm(const Eigen::VectorXd& residual) const {
  find_stiffness();
  double square = 0;
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    if (elements_[i].size() == 0) continue;
    const Eigen::VectorXd part = residual.segment(first_[i], elements_[i].size());
    square += stiffness_factors_[i].matrixL().solve(part).squaredNorm();
  }
  return std::sqrt(square);
}

bool RodChain::factor(double share) {
  negative_ = 0;
  if (share != 0) find_stiffness();
  Matrix6d beyond = Matrix6d::Zero();  // Wrench of all distal sections, by the twist of their base.
  for (std::size_t i = elements_.size(); i-- > 0;) {
    const RodElement& element = elements_[i];
    Pivot& pivot = pivots_[i];
    if (element.size() == 0) {
      if (is_loaded_) beyond += element.wrench_by_base;
      continue;
    }
    pivot.matrix = element.tangent;
    if (share != 0) pivot.matrix += share * stiffness_[i];
    if (is_loaded_) {
      const RodElement::Columns& A = element.columns().back();
      pivot.wrench_by_modes = element.wrench_by_modes;
      pivot.by_base = element.by_base;
      pivot.by_base.noalias() += A.transpose().lazyProduct(beyond);
      const RodElement::Columns carried = beyond * A;
      pivot.wrench_by_modes += carried;
      pivot.matrix.noalias() -= A.transpose().lazyProduct(carried);
    }
    if (!pivot.matrix.allFinite()) return false;
    pivot.is_definite = false;
    if (is_symmetric_) {
      pivot.cholesky.compute(pivot.matrix);
      pivot.is_definite = pivot.cholesky.info() == Eigen::Success;
    }
    if (!pivot.is_definite) {
      pivot.lu.compute(pivot.matrix);
      if (is_symmetric_) {
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(pivot.matrix, Eigen::EigenvaluesOnly);
        negative_ += static_cast<int>((eigen.eigenvalues().array() < 0).count());
      } else if (is_negative(pivot.lu)) {
        negative_ = 1 - negative_;
      }
    }
    if (is_loaded_) {
      solve_pivot(pivot, pivot.by_base);
      beyond += element.wrench_by_base;
      beyond.noalias() += pivot.wrench_by_modes * pivot.by_base;
    }
  }
  return true;
}

void RodChain::solve_pivot(const Pivot& pivot, Eigen::Ref<Eigen::MatrixXd> rhs) {
  if (pivot.is_definite) {
    pivot.cholesky.solveInPlace(rhs);
  } else {
    rhs = pivot.lu.solve(rhs);
  }
}

void RodChain::solve(Eigen::Ref<Eigen::MatrixXd> rhs) {
  RodElement::Columns along = RodElement::Columns::Zero(6, rhs.cols());
  for (std::size_t i = elements_.size(); i-- > 0;) {
    if (elements_[i].size() == 0) continue;
    auto part = rhs.middleRows(first_[i], elements_[i].size());
    if (is_loaded_) part.noalias() += elements_[i].columns().back().transpose() * along;
    solve_pivot(pivots_[i], part);
    if (is_loaded_) along.noalias() += pivots_[i].wrench_by_modes * part;
  }
  if (!is_loaded_) return;
  along.setZero();
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    if (elements_[i].size() == 0) continue;
    auto part = rhs.middleRows(first_[i], elements_[i].size());
    part.noalias() += pivots_[i].by_base * along;
    along.noalias() += elements_[i].columns().back() * part;
  }
}

Eigen::MatrixXd RodChain::parameter_slopes(const Eigen::Vector3d& gravity) const {
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(size_, 5 * static_cast<Eigen::Index>(rod_.sections.size()));
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const auto column = 5 * static_cast<Eigen::Index>(elements_[i].part().section);
    elements_[i].add_stiffness_slopes(slopes.block(first_[i], column, elements_[i].size(), 4));
    Vector6d wrench = Vector6d::Zero();
    elements_[i].add_weight_slope(gravity, wrench,
                                  slopes.col(column + 4).segment(first_[i], elements_[i].size()));
    for (std::size_t before = 0; before < i; ++before)
      slopes.col(column + 4).segment(first_[before], elements_[before].size()) -=
          elements_[before].columns().back().transpose() * wrench;
  }
  return slopes;
}

bool RodChain::has_friction() const {
  return is_rubbing_ &&
         std::ranges::any_of(rod_.tendons, [](const TendonRoute& tendon) { return tendon.friction > 0; });
}

Eigen::VectorXd RodChain::friction_change(const Eigen::VectorXd& dq, std::span<const double> tensions) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
  for (std::size_t i = 0; i < tendons(); ++i) {
    const double friction = rod_.tendons[i].friction;
    if (friction == 0 || tensions[i] == 0) continue;
    RodElement::Run run;
    RodElement::RunChange change;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const Eigen::VectorXd part = dq.segment(first_[e], elements_[e].size());
      elements_[e].rub_change(i, friction, tensions[i], part, run, change,
                              result.segment(first_[e], elements_[e].size()));
      if (has_chords_) change.base += elements_[e].columns().back() * part;
    }
  }
  return result;
}

Eigen::MatrixXd RodChain::friction_form(std::span<const double> tensions) const {
  Eigen::MatrixXd form(size_, size_);
  for (Eigen::Index j = 0; j < size_; ++j)
    form.col(j) = friction_change(Eigen::VectorXd::Unit(size_, j), tensions);
  return form;
}

void RodChain::columns_at(std::size_t element, std::size_t node, Eigen::Ref<RodElement::Columns> J) const {
  J.setZero();
  for (std::size_t i = 0; i <= element; ++i) {
    const std::size_t last = i == element ? node : elements_[i].columns().size() - 1;
    J.middleCols(first_[i], elements_[i].size()) = elements_[i].columns()[last];
  }
}

}  // namespace flexura
