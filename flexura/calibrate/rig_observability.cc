#include "flexura/calibrate/rig_observability.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

// Share of the prior below which a variable counts as observed.
constexpr double determined = 0.5;

// Describes the largest components of a direction; the largest is made positive.
std::string words_of(const RigVariables& variables, const Eigen::VectorXd& direction) {
  constexpr std::size_t most = 4;
  constexpr double least = 0.25;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(direction.size()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(
      order, [&](Eigen::Index a, Eigen::Index b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  const double sign = direction[order.front()] < 0 ? -1 : 1;
  std::string words;
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i) {
    const double part = sign * direction[order[i]];
    if (i > 0 && std::abs(part) < least) break;
    words += fmt::format("{}{} ({:+.2f})", i > 0 ? " with " : "", variables.variable(order[i]).name, part);
  }
  return words;
}

}  // namespace

RigObservability observability(const RigVariables& variables, const Eigen::MatrixXd& covariance) {
  RigObservability result;
  const Eigen::Index count = variables.globals();
  Eigen::VectorXd scales(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const RigVariables::Variable& variable = variables.variable(i);
    scales[i] = variable.scale;
    const double sigma = std::sqrt(covariance(i, i));
    result.numbers.push_back({variable.name, variable.sigma, sigma, sigma < determined * variable.scale});
  }
  const Eigen::MatrixXd left = scales.cwiseInverse().asDiagonal() * covariance.topLeftCorner(count, count) *
                               scales.cwiseInverse().asDiagonal();
  const auto [values, vectors] = symmetric_eigen(left);
  for (Eigen::Index i = count - 1; i >= 0; --i) {
    const double share = std::sqrt(std::max(0.0, values[i]));
    if (share < determined) break;
    result.unobservable.push_back({share, words_of(variables, vectors.col(i))});
  }
  return result;
}

}  // namespace flexura
