#include "flexura/math/derivative_check.h"

#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace flexura {
namespace {

constexpr std::size_t steps = 8;
constexpr double shrink = 1.6;

Eigen::VectorXd central_difference(const VectorFunction& f, Eigen::VectorXd x, Eigen::Index column,
                                   double step) {
  const double centre = x[column];
  x[column] = centre + step;
  const double upper = x[column];
  const Eigen::VectorXd ahead = f(x);
  x[column] = centre - step;
  // Divides by the actual steps, which differ from the requested steps by rounding.
  return (ahead - f(x)) / (upper - x[column]);
}

// Keeps, for each element, the extrapolated estimate that agrees best with the two estimates from which it
// was computed.
void keep_best(const Eigen::VectorXd& value, const Eigen::VectorXd& error, Eigen::Index column,
               NumericalJacobian& best) {
  for (Eigen::Index row = 0; row < value.size(); ++row) {
    if (!(error[row] <= best.error(row, column))) continue;
    best.error(row, column) = error[row];
    best.value(row, column) = value[row];
  }
}

void fill_column(const VectorFunction& f, const Eigen::VectorXd& x, Eigen::Index column, double step,
                 NumericalJacobian& best) {
  std::array<Eigen::VectorXd, steps> previous;  // Row of the previous step in Neville's tableau.
  std::array<Eigen::VectorXd, steps> current;   // Row of this step, by increasing order.
  for (std::size_t i = 0; i < steps; ++i, step /= shrink) {
    current[0] = central_difference(f, x, column, step);
    double factor = 1.0;
    for (std::size_t order = 1; order <= i; ++order) {
      factor *= shrink * shrink;
      current[order] = (factor * current[order - 1] - previous[order - 1]) / (factor - 1.0);
      const Eigen::VectorXd error = (current[order] - current[order - 1])
                                        .cwiseAbs()
                                        .cwiseMax((current[order] - previous[order - 1]).cwiseAbs());
      keep_best(current[order], error, column, best);
    }
    std::swap(previous, current);
  }
}

}  // namespace

NumericalJacobian numerical_jacobian(const VectorFunction& f, const Eigen::VectorXd& x, double step) {
  const Eigen::Index rows = f(x).size();
  NumericalJacobian best{Eigen::MatrixXd::Zero(rows, x.size()),
                         Eigen::MatrixXd::Constant(rows, x.size(), std::numeric_limits<double>::infinity())};
  for (Eigen::Index column = 0; column < x.size(); ++column) fill_column(f, x, column, step, best);
  return best;
}

}  // namespace flexura
