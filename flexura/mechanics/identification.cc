#include "flexura/mechanics/identification.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/base/work_progress.h"
#include "flexura/math/dense.h"
#include "flexura/mechanics/identification_equations.h"
#include "flexura/mechanics/identification_terms.h"

namespace flexura {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr int weightings = 8;
// Number of linearisations with friction, and their tolerance as part of a standard deviation.
constexpr int linearizations = 12;
constexpr double settled = 0.01, settled_at_all = 1e-6;
// Further initial friction coefficients, if the rod's own value gives no solution.
constexpr std::array<double, 2> other_friction = {0.1, 0.3};
// Ridge for rounding, relative to the variances of correlated equations.
constexpr double ridge = 1e-9;
// Largest part of a coefficient that may be noise before its parameter counts as unobservable.
constexpr double most_noise = 0.5;
// Least scaled information of an observable direction.
constexpr double least_information = 1e-9;

double trace_of(const MatrixXd& A, const MatrixXd& B) { return A.cwiseProduct(B).sum(); }

// Returns which parameters are observable: those without a part in any direction that has no information.
std::vector<char> observable(const MatrixXd& information, const MatrixXd& by_noise) {
  const Index count = information.rows();
  std::vector<char> is(static_cast<std::size_t>(count), 0);
  std::vector<Index> seen;
  for (Index g = 0; g < count; ++g)
    if (information(g, g) > 0 && by_noise(g, g) < most_noise * information(g, g)) seen.push_back(g);
  if (seen.empty()) return is;
  MatrixXd scaled = (information - by_noise)(seen, seen);
  const VectorXd size = scaled.diagonal().cwiseSqrt().cwiseInverse();
  scaled = (size.asDiagonal() * scaled * size.asDiagonal()).eval();
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    double part = 0;
    for (Index k = 0; k < eigen.values.size(); ++k)
      if (!(eigen.values[k] > least_information))
        part += std::pow(eigen.vectors(static_cast<Index>(i), k), 2);
    is[static_cast<std::size_t>(seen[i])] = part < 1e-6 ? 1 : 0;
  }
  return is;
}

// Weighted least squares of A x + c by the inverse covariance W, with the noise's contribution subtracted.
struct Fit {
  // Of all parameters; by_noise is the contribution of noise in the coefficients.
  MatrixXd information, by_noise;
  VectorXd slope;  // Gradient of half the sum of squares at the values, without the noise's contribution.
};

Fit fit_at(const IdentificationEquations& equations, const MatrixXd& W, const VectorXd& values) {
  const Index count = values.size();
  const MatrixXd& A = equations.by_parameter;
  const VectorXd left = A * values + equations.fixed;
  Fit fit{.information = A.transpose() * W * A,
          .by_noise = MatrixXd::Zero(count, count),
          .slope = A.transpose() * (W * left)};
  if (!equations.has_noise()) return fit;
  for (Index g = 0; g < count; ++g) {
    fit.slope[g] -= trace_of(W, equations.noise(g + 1, 0));
    for (Index h = 0; h < count; ++h) {
      fit.by_noise(g, h) = trace_of(W, equations.noise(g + 1, h + 1));
      fit.slope[g] -= fit.by_noise(g, h) * values[h];
    }
  }
  return fit;
}

MatrixXd inverse_covariance(const IdentificationEquations& equations, const VectorXd& values) {
  const Index rows = equations.fixed.size();
  if (!equations.has_noise()) {
    // Equations of the same scale; no more is known.
    return equations.scales.cwiseAbs2().cwiseInverse().asDiagonal();
  }
  MatrixXd C = MatrixXd::Zero(rows, rows);
  const Index count = values.size();
  for (Index g = 0; g <= count; ++g)
    for (Index h = 0; h <= count; ++h)
      C += (g == 0 ? 1 : values[g - 1]) * (h == 0 ? 1 : values[h - 1]) * equations.noise(g, h);
  VectorXd size = C.diagonal();
  const double greatest = size.maxCoeff();
  for (Index i = 0; i < rows; ++i) {
    if (!(size[i] > 1e-20 * greatest)) size[i] = greatest > 0 ? 1e-20 * greatest : 1;
  }
  size = size.cwiseSqrt().cwiseInverse().eval();
  C = (size.asDiagonal() * C * size.asDiagonal()).eval();
  C.diagonal().array() += ridge;
  return size.asDiagonal() * Cholesky(0.5 * (C + C.transpose())).inverse() * size.asDiagonal();
}

// Returns the rod with the estimated friction.
Rod with_friction(Rod rod, const std::vector<RodParameter>& parameters, const VectorXd& values) {
  constexpr double most = 10;
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    if (parameters[g].kind != RodParameter::Kind::friction) continue;
    for (const std::size_t i : rubbing_tendons(rod, parameters[g]))
      rod.tendons[i].friction = std::clamp(values[static_cast<Index>(g)], 0.0, most);
  }
  return rod;
}

// Solves the least squares around a rod's friction, starting from nearby values.
Identification solve(const IdentificationEquations& equations, const std::vector<RodParameter>& parameters) {
  const auto count = static_cast<Index>(parameters.size());
  const Index rows = equations.fixed.size();
  Identification result{.values = equations.nominal,
                        .sigma = VectorXd::Constant(count, std::numeric_limits<double>::infinity()),
                        .covariance = MatrixXd::Zero(count, count),
                        .is_observable = std::vector<char>(parameters.size(), 0),
                        .equations = static_cast<int>(rows)};
  MatrixXd W = inverse_covariance(equations, result.values);
  std::vector<Index> seen;
  for (int pass = 0; pass < weightings; ++pass) {
    const Fit fit = fit_at(equations, W, result.values);
    if (!fit.information.allFinite() || !fit.slope.allFinite())
      throw std::invalid_argument("the numbers of the record are too large");
    if (pass == 0 || pass + 1 == weightings) {
      result.is_observable = observable(fit.information, fit.by_noise);
      seen.clear();
      for (Index g = 0; g < count; ++g)
        if (result.is_observable[static_cast<std::size_t>(g)] != 0) seen.push_back(g);
    }
    if (seen.empty()) break;
    const MatrixXd clear = (fit.information - fit.by_noise)(seen, seen);
    const VectorXd scale = clear.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
    const Cholesky factors(scale.asDiagonal() * clear * scale.asDiagonal());
    if (!factors.is_definite()) {
      // Noise hides the information.
      std::ranges::fill(result.is_observable, char{0});
      result.values = equations.nominal;
      seen.clear();
      break;
    }
    const MatrixXd inverse = scale.asDiagonal() * factors.inverse() * scale.asDiagonal();
    result.values(seen) -= inverse * fit.slope(seen);
    result.covariance(seen, seen) = inverse * fit.information(seen, seen) * inverse;
    if (equations.has_noise()) W = inverse_covariance(equations, result.values);
  }
  for (Index g = 0; g < count; ++g) {
    if (result.is_observable[static_cast<std::size_t>(g)] != 0) continue;
    result.values[g] = equations.nominal[g];
    result.covariance.row(g).setZero();
    result.covariance.col(g).setZero();
  }
  const VectorXd left = equations.by_parameter * result.values + equations.fixed;
  const Index freedom = std::max<Index>(1, rows - static_cast<Index>(seen.size()));
  result.misfit = left.dot(W * left) / static_cast<double>(freedom);
  if (!equations.has_noise()) {
    result.covariance *= result.misfit;
    result.misfit = 1;
  }
  for (const Index g : seen) result.sigma[g] = std::sqrt(result.covariance(g, g));
  return result;
}

constexpr std::string_view solving = "solving for the parameters";

bool is_friction(const RodParameter& parameter) { return parameter.kind == RodParameter::Kind::friction; }

// Repeats the least squares, linearised at the last friction, until the friction settles. `values`: the
// start.
Identification settle(const Rod& rod, const std::vector<RodParameter>& parameters,
                      const RodMotionRecord& record, const IdentificationConfig& config,
                      const VectorXd& values, Progress& progress) {
  Identification found;
  found.values = values, found.converged = false;
  for (int pass = 0; pass < linearizations && !found.converged; ++pass) {
    const VectorXd before = found.values;
    found = solve(IdentificationEquations(with_friction(rod, parameters, before), parameters, record, config),
                  parameters);
    progress.update(static_cast<double>(pass + 1) / linearizations, solving);
    found.converged = true;
    for (std::size_t g = 0; g < parameters.size(); ++g) {
      if (!is_friction(parameters[g]) || found.is_observable[g] == 0) continue;
      const auto at = static_cast<Index>(g);
      const double change = std::abs(found.values[at] - before[at]);
      if (!(change <= std::max(settled * found.sigma[at], settled_at_all))) found.converged = false;
    }
  }
  return found;
}

// Returns whether all friction coefficients are observable.
bool has_friction(const Identification& found, const std::vector<RodParameter>& parameters) {
  for (std::size_t g = 0; g < parameters.size(); ++g)
    if (is_friction(parameters[g]) && found.is_observable[g] == 0) return false;
  return true;
}

// Identifies all parameters but friction, which keeps the rod's value.
Identification without_friction(const IdentificationEquations& first, const Rod& rod,
                                const std::vector<RodParameter>& parameters, const RodMotionRecord& record,
                                const IdentificationConfig& config) {
  std::vector<RodParameter> rest;
  std::vector<Index> places;
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    if (is_friction(parameters[g])) continue;
    rest.push_back(parameters[g]), places.push_back(static_cast<Index>(g));
  }
  const auto count = static_cast<Index>(parameters.size());
  Identification result;
  result.values = first.nominal;
  result.sigma = VectorXd::Constant(count, std::numeric_limits<double>::infinity());
  result.covariance = MatrixXd::Zero(count, count);
  result.is_observable.assign(parameters.size(), 0);
  result.equations = static_cast<int>(first.fixed.size());
  if (rest.empty()) return result;
  const Identification found = solve(IdentificationEquations(rod, rest, record, config), rest);
  result.values(places) = found.values;
  result.sigma(places) = found.sigma;
  result.covariance(places, places) = found.covariance;
  result.misfit = found.misfit;
  for (std::size_t i = 0; i < rest.size(); ++i)
    result.is_observable[static_cast<std::size_t>(places[i])] = found.is_observable[i];
  return result;
}

}  // namespace

Identification identify(const Rod& rod, const std::vector<RodParameter>& parameters,
                        const RodMotionRecord& record, const IdentificationConfig& config,
                        Progress* progress) {
  NoProgress nobody;
  Progress& watching = progress != nullptr ? *progress : nobody;
  watching.update(0, solving);
  const IdentificationEquations first(rod, parameters, record, config);
  if (std::ranges::none_of(parameters, is_friction)) return solve(first, parameters);
  // In a model without friction, tendons slide at any speed, and noise determines the direction. So the fit
  // needs other initial values.
  std::vector<VectorXd> starts = {first.nominal};
  for (const double other : other_friction) {
    VectorXd start = first.nominal;
    for (std::size_t g = 0; g < parameters.size(); ++g)
      if (is_friction(parameters[g])) start[static_cast<Index>(g)] = other;
    starts.push_back(std::move(start));
  }
  std::optional<Identification> unsettled;
  WorkProgress work(watching, std::vector<double>(starts.size(), 1));
  for (std::size_t i = 0; i < starts.size(); ++i) {
    Identification found = settle(rod, parameters, record, config, starts[i], work.piece(i));
    if (!has_friction(found, parameters)) continue;
    if (found.converged) return found;
    if (!unsettled) unsettled = std::move(found);
  }
  return unsettled ? *std::move(unsettled) : without_friction(first, rod, parameters, record, config);
}

}  // namespace flexura
