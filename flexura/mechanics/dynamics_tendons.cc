// Linear systems of a step's iterations, with the tensions of tendons that are held at displacements.
#include <cmath>
#include <cstddef>
#include <optional>

#include "flexura/mechanics/complementary.h"
#include "flexura/mechanics/dynamics_work.h"

namespace flexura {

// Solves for the x_i >= 0 of taut tendons in the sum of x_i answers_i, for a small positive definite matrix,
// by changing one slack tendon at a time (principal pivots).
bool RodDynamics::Work::pull_tight() {
  const Eigen::Index count = found_.size();
  const double rounding = 1e-13 * chain.rod().length();
  for (int round = 0; round < 50 + 10 * static_cast<int>(count); ++round) {
    // Cholesky decomposition of the rows of taut tendons.
    found_.setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      if (taut_[static_cast<std::size_t>(i)] == 0) continue;
      double right = desired_[i], diagonal = give_(i, i);
      for (Eigen::Index j = 0; j < i; ++j) {
        if (taut_[static_cast<std::size_t>(j)] == 0) continue;
        double sum = give_(i, j);
        for (Eigen::Index k = 0; k < j; ++k)
          if (taut_[static_cast<std::size_t>(k)] != 0) sum -= pivot_(i, k) * pivot_(j, k);
        pivot_(i, j) = sum / pivot_(j, j);
        diagonal -= pivot_(i, j) * pivot_(i, j);
        right -= pivot_(i, j) * found_[j];
      }
      if (!(diagonal > 0)) return false;
      pivot_(i, i) = std::sqrt(diagonal);
      found_[i] = right / pivot_(i, i);
    }
    for (Eigen::Index i = count; i-- > 0;) {
      if (taut_[static_cast<std::size_t>(i)] == 0) continue;
      found_[i] /= pivot_(i, i);
      for (Eigen::Index k = 0; k < i; ++k)
        if (taut_[static_cast<std::size_t>(k)] != 0) found_[k] -= pivot_(i, k) * found_[i];
    }
    Eigen::Index worst = -1;
    double least = 0;
    for (Eigen::Index i = 0; i < count; ++i)
      if (taut_[static_cast<std::size_t>(i)] != 0 && found_[i] < least) worst = i, least = found_[i];
    if (worst >= 0) {
      taut_[static_cast<std::size_t>(worst)] = 0;
      continue;
    }
    least = -rounding;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (taut_[static_cast<std::size_t>(i)] != 0) continue;
      double left = -desired_[i];
      for (Eigen::Index j = 0; j < count; ++j) left += give_(i, j) * found_[j];
      if (!std::isfinite(left)) return false;
      if (left < least) worst = i, least = left;
    }
    if (worst < 0) return true;
    taut_[static_cast<std::size_t>(worst)] = 1;
  }
  return false;
}

// Solves for tensions with friction, where the matrix is not symmetric.
bool RodDynamics::Work::find_tensions() {
  Complementary problem{.matrix = give_, .rhs = desired_, .kinds = {}};
  problem.kinds.assign(taut_.size(), Complementary::Kind::at_least_0);
  const std::optional<Eigen::VectorXd> found = problem.solve(taut_, 1e-13 * chain.rod().length());
  if (!found) return false;
  found_ = *found;
  return true;
}

// On entry change_ is the residual at the stage with the present tensions. It becomes the step without
// tendons. Then tensions are found that meet the given lengths, and change_ includes them.
template <typename Solve>
bool RodDynamics::Work::solve_with_tendons(const Stage& stage, Solve&& solve) {
  const Eigen::Index count = found_.size();
  // How tensions act: without friction, by the derivatives of the lengths.
  const Eigen::MatrixXd& pulls = rubs() ? pull_slopes_ : length_slopes_;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double tension = tensions[static_cast<std::size_t>(i)];
    if (tension != 0) change_ += stage.stretch * tension * pulls.col(i);
  }
  left_ = change_;
  solve(change_.data());
  for (Eigen::Index i = 0; i < count; ++i) {
    answers_.col(i) = pulls.col(i);
    solve(answers_.col(i).data());
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto tendon = static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j < count; ++j)
      give_(i, j) = stage.stretch * stage.stretch * length_slopes_.col(i).dot(answers_.col(j));
    give_(i, i) += compliance[tendon];
    desired_[i] = lengths_[i] - rest_lengths[tendon] + stage.tendons.displacements[tendon] +
                  stage.stretch * length_slopes_.col(i).dot(change_);
  }
  if (!(rubs() ? find_tensions() : pull_tight())) return false;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto tendon = static_cast<std::size_t>(i);
    change_ -= stage.stretch * found_[i] * answers_.col(i);
    left_ -= stage.stretch * found_[i] * pulls.col(i);
    pull_change_[i] = found_[i] - tensions[tendon];
    tensions[tendon] = found_[i];
  }
  return true;
}

bool RodDynamics::Work::solve_quickly(const Stage& stage) {
  if (stage.by_displacement()) return solve_with_tendons(stage, [this](double* x) { matrix.solve(x); });
  left_ = change_;
  matrix.solve(change_.data());
  return true;
}

bool RodDynamics::Work::solve_exactly(const Stage& stage) {
  const auto solve = [this](double* x) {
    Eigen::Map<Eigen::VectorXd> rhs(x, change_.size());
    rhs = factor_->lu.solve(rhs).eval();
  };
  if (stage.by_displacement()) return solve_with_tendons(stage, solve);
  left_ = change_;
  solve(change_.data());
  return true;
}

}  // namespace flexura
