#include "flexura/mechanics/rod_descent.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

constexpr int max_descent_steps = 400, max_tries = 60;
// Longest step, radians of a section's bend (RodChain::scales): longer ones might pass over an equilibrium.
constexpr double longest_descent = 0.5;
constexpr double at_rest = 1e-9;
// Share of the rod's stiffness added: first value, value below which none is added, and maximum.
constexpr double first_part = 0.1, no_part = 1e-3, most_part = 1e9;
// Size of a push out of a saddle, in the unit of longest_descent.
constexpr double push = 0.02;
constexpr int max_inverse = 40;
// Relative to the stiffness: a smaller eigenvalue counts as no stiffness, positive or negative.
constexpr double neutral = 1e-7;
constexpr int max_pushes = 6;
constexpr double same_energy = 1e-9;
constexpr double huge = std::numeric_limits<double>::infinity();

}  // namespace

RodDescent::RodDescent(RodChain& chain, const RodLoads& loads)
    : chain_(chain),
      loads_(loads),
      has_energy_(chain.has_energy(loads)),
      has_friction_(chain.has_friction()),
      tensions_(chain.tendons()) {}

double RodDescent::measure(const Eigen::VectorXd& change) const {
  return change.size() > 0 ? change.cwiseProduct(chain_.scales()).cwiseAbs().maxCoeff() : 0;
}

bool RodDescent::look(const Eigen::VectorXd& q, const std::vector<Held>& tendons) {
  if (!q.allFinite()) return false;
  // Tensions of held tendons follow from their lengths, which depend on q only.
  for (std::size_t i = 0; i < tendons.size(); ++i) tensions_[i] = tendons[i].is_held ? 0 : tendons[i].tension;
  if (std::ranges::any_of(tendons, &Held::is_held)) {
    chain_.balance(q, tensions_, loads_, 1);
    for (std::size_t i = 0; i < tendons.size(); ++i) {
      const Held& held = tendons[i];
      if (!held.is_held) continue;
      const double over = chain_.tendon_lengths()[static_cast<Eigen::Index>(i)] - held.length;
      tensions_[i] = std::max(0.0, (over + held.penalty * held.tension) / (held.compliance + held.penalty));
    }
  }
  chain_.balance(q, tensions_, loads_, 1);
  residual_ = chain_.residual();
  energy_ = chain_.strain_energy() + chain_.load_energy(loads_);
  scale_ = chain_.strain_energy() + std::abs(chain_.load_energy(loads_));
  taut_.clear();
  for (std::size_t i = 0; i < tendons.size(); ++i) {
    const Held& held = tendons[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double part = held.is_held ? 0.5 * (held.compliance + held.penalty) * tensions_[i] * tensions_[i]
                                     : tensions_[i] * chain_.tendon_lengths()[at];
    energy_ += part;
    scale_ += part;
    if (held.is_held && tensions_[i] > 0) taut_.push_back(at);
  }
  const bool has_positive_stretch = std::ranges::all_of(chain_.elements(), [](const RodElement& element) {
    return std::ranges::all_of(element.strains(), [](const Vector6d& strain) { return strain[2] > 0; });
  });
  return has_positive_stretch && residual_.allFinite() && std::isfinite(energy_);
}

int RodDescent::solve(double share, const std::vector<Held>& tendons) {
  ++iterations_;
  if (!chain_.factor(share)) return -1;
  int negative = chain_.negative_count();
  bool turns_over = false;  // Friction changes the sign of the determinant.
  if (has_friction_) {
    Eigen::MatrixXd form = chain_.friction_form(tensions_);
    chain_.solve(form);
    form.diagonal().array() += 1;
    if (!form.allFinite()) return -1;
    friction_.compute(form);
    turns_over = !(friction_.determinant() > 0);
  }
  by_taut_ = chain_.pull_slopes()(Eigen::all, taut_);
  if (!taut_.empty()) {
    solve_untied(by_taut_);
    Eigen::MatrixXd give = chain_.length_slopes()(Eigen::all, taut_).transpose() * by_taut_;
    for (std::size_t a = 0; a < taut_.size(); ++a) {
      const Held& held = tendons[static_cast<std::size_t>(taut_[a])];
      const auto at = static_cast<Eigen::Index>(a);
      give(at, at) += held.compliance + held.penalty;
    }
    if (!give.allFinite()) return -1;
    // Inertia of the whole matrix from both parts (E. Haynsworth, 1968).
    const SymmetricEigen eigen = symmetric_eigen(0.5 * (give + give.transpose()));
    negative = chain_.negative_count(static_cast<int>((eigen.values.array() < 0).count()));
    give_inverse_ = pseudo_inverse(give);
  }
  Eigen::MatrixXd step = -residual_;
  finish_solve(step);
  step_ = step;
  return step_.allFinite() ? negative + (turns_over ? 1 : 0) : -1;
}

void RodDescent::solve_untied(Eigen::MatrixXd& columns) const {
  chain_.solve(columns);
  if (has_friction_) columns = friction_.solve(columns).eval();
}

void RodDescent::finish_solve(Eigen::MatrixXd& columns) const {
  solve_untied(columns);
  if (taut_.empty()) return;
  const Eigen::MatrixXd longer = chain_.length_slopes()(Eigen::all, taut_).transpose() * columns;
  columns -= by_taut_ * (give_inverse_ * longer);
}

RodDescent::Step RodDescent::step(Eigen::VectorXd& q, const std::vector<Held>& tendons) {
  for (int attempt = 0; attempt < max_tries && share_ < most_part; ++attempt) {
    const int negative = solve(share_, tendons);
    const double work = -residual_.dot(step_), size = measure(step_);
    const auto slower = [&] { share_ = std::max(4 * share_, last_share_ > 0 ? last_share_ : first_part); };
    if (negative != 0 || !(work >= 0) || size > longest_descent) {
      slower();
      continue;
    }
    if (size * (1 + share_) <= at_rest) return Step::rest;
    const Eigen::VectorXd held_back = share_ * chain_.stiffness_times(step_), before = residual_;
    const double energy = energy_;
    const Eigen::VectorXd next = q + step_;
    // Relative error of the step's linearised equations.
    double wrong = 1;
    if (look(next, tendons)) {
      if (has_energy_) {
        const double predicted = 0.5 * (work + step_.dot(held_back)), rounding = 1e-13 * scale_;
        wrong = predicted <= rounding ? 0 : 1 - (energy - energy_ + rounding) / predicted;
      } else {
        wrong = chain_.stiffness_norm(residual_ + held_back) / chain_.stiffness_norm(before);
      }
    }
    const double most = has_energy_ ? 0.8 : 0.3;
    if (wrong <= most) {
      q = next;
      last_share_ = share_;
      if (wrong > 0.75 * most) slower();
      if (wrong < 0.3 * most) share_ = share_ < no_part ? 0 : share_ / 6;
      return Step::made;
    }
    slower();
    if (!look(q, tendons)) return Step::none;
  }
  return Step::none;
}

// Leaves along the eigenvector of the least eigenvalue, found by inverse iteration.
RodDescent::Saddle RodDescent::leave_saddle(Eigen::VectorXd& q, const std::vector<Held>& tendons) {
  double share = first_part;
  while (solve(share, tendons) != 0) {
    share *= 2;
    if (share > most_part) return Saddle::none;
  }
  Eigen::MatrixXd direction(q.size(), 1);
  for (Eigen::Index i = 0; i < q.size(); ++i)
    direction(i, 0) = std::sin(1 + 2.4 * static_cast<double>(i) + 0.5 * pushes_) / chain_.scales()[i];
  double least = 0;
  const int inversions = pushes_ < 2 ? max_inverse : 1;  // Then another direction.
  for (int i = 0; i < inversions; ++i) {
    const Eigen::VectorXd stiffness = chain_.stiffness_times(direction);
    const double square = stiffness.dot(direction.col(0));
    direction = stiffness;
    finish_solve(direction);
    least = square / stiffness.dot(direction.col(0)) - share;
    const double size = measure(direction);
    if (!(size > 0) || !std::isfinite(size)) return Saddle::none;
    direction *= push / size;
  }
  if (pushes_ < 2 && least > -neutral) return Saddle::neutral;
  q += direction.col(0);
  const double ahead = look(q, tendons) ? energy_ : huge;
  if (!has_energy_ && ahead < huge) return Saddle::left;
  q -= 2 * direction.col(0);
  // Tries the lower side first, then the other one.
  if (look(q, tendons) && (energy_ <= ahead) == (pushes_ % 2 == 0)) return Saddle::left;
  q += 2 * direction.col(0);
  return look(q, tendons) ? Saddle::left : Saddle::none;
}

bool RodDescent::fall(Eigen::VectorXd& q, std::vector<Held>& tendons) {
  share_ = last_share_ = 0, pushes_ = 0;
  has_energy_ = chain_.has_energy(loads_), has_friction_ = chain_.has_friction();
  is_neutral_ = false;
  if (!look(q, tendons)) return false;
  double lowest = huge;  // Lowest energy of the saddles met.
  for (int i = 0; i < max_descent_steps; ++i) {
    const Step made = step(q, tendons);
    if (made == Step::none || chain_.disks_meet()) return false;
    if (made == Step::made) continue;
    const bool is_saddle = share_ > 0 && solve(0, tendons) != 0;
    share_ = last_share_ = 0;
    if (is_saddle) {
      // Back at an equilibrium that it was pushed from: tendons that are just taut hold it there.
      pushes_ = energy_ < lowest - same_energy * scale_ ? 0 : pushes_ + 1;
      lowest = std::min(lowest, energy_);
      is_neutral_ = has_energy_ && pushes_ >= max_pushes;
      if (!is_neutral_) {
        const Saddle saddle = leave_saddle(q, tendons);
        if (saddle == Saddle::none) return false;
        if (saddle == Saddle::left) continue;
        is_neutral_ = true;
      }
    }
    for (std::size_t t = 0; t < tendons.size(); ++t) tendons[t].tension = tensions_[t];
    return true;
  }
  return false;
}

}  // namespace flexura
