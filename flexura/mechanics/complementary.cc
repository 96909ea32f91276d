#include "flexura/mechanics/complementary.h"

#include <Eigen/LU>
#include <cstddef>

namespace flexura {

std::optional<Eigen::VectorXd> Complementary::solve(std::vector<char>& held_off, double rounding) const {
  const auto count = static_cast<Eigen::Index>(kinds.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] == Kind::none) held_off[i] = 0;
    if (kinds[i] == Kind::free) held_off[i] = 1;
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(count);
  if (!matrix.allFinite() || !rhs.allFinite()) return std::nullopt;
  const int most = 20 + 6 * static_cast<int>(kinds.size());
  std::vector<Eigen::Index> open;
  for (int pivot = 0; pivot < most; ++pivot) {
    open.clear();
    for (Eigen::Index i = 0; i < count; ++i)
      if (held_off[static_cast<std::size_t>(i)] != 0) open.push_back(i);
    x.setZero();
    if (!open.empty()) {
      const Eigen::MatrixXd part = matrix(open, open);
      const Eigen::VectorXd desired = rhs(open);
      x(open) = part.partialPivLu().solve(desired).eval();
    }
    if (!x.allFinite()) return std::nullopt;
    // What would go below 0 is held there, then what is below its own bound is let go; the worst first.
    Eigen::Index worst = -1;
    double least = 0;
    for (const Eigen::Index i : open) {
      if (kinds[static_cast<std::size_t>(i)] == Kind::free || x[i] >= least) continue;
      worst = i, least = x[i];
    }
    if (worst >= 0) {
      held_off[static_cast<std::size_t>(worst)] = 0;
      continue;
    }
    const Eigen::VectorXd left = matrix * x - rhs;
    least = -rounding;
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (held_off[at] != 0 || kinds[at] != Kind::at_least_0 || left[i] >= least) continue;
      worst = i, least = left[i];
    }
    if (worst < 0) return x;
    held_off[static_cast<std::size_t>(worst)] = 1;
  }
  return std::nullopt;
}

}  // namespace flexura
