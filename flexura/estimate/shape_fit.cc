#include "flexura/estimate/shape_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "flexura/math/levenberg_marquardt.h"
#include "flexura/math/median.h"

namespace flexura {
namespace {

using RowKind = ShapeProblem::RowKind;

// Median of |x| of a standard normal deviate.
constexpr double median_size = 0.6745;
// In standard deviations: beyond this a residual's weight decreases with its size.
constexpr double uncertain = 4;
// px; limits the cost of a point far from the shape.
constexpr double far_away = 3;

double bounded_square(double r, double cutoff) {
  const double ratio = r / cutoff;
  return r * r / (1 + ratio * ratio);
}

// Ratio of the variance of a series' mean to that of independent values: 1 + 2 sum of its correlations, as
// long as these are positive (C. J. Geyer, 1992).
double correlation_factor(std::span<const double> series) {
  const std::size_t count = series.size();
  double square = 0;
  for (const double r : series) square += r * r;
  if (!(square > 0)) return 1;
  double factor = 1;
  for (std::size_t lag = 1; lag < count / 4; ++lag) {
    double product = 0;
    for (std::size_t i = lag; i < count; ++i) product += series[i] * series[i - lag];
    if (product <= 0.05 * square) break;
    factor += 2 * product / square;
  }
  return factor;
}

double cost_of(const ShapeProblem& problem, double cutoff) {
  double sum = 0;
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    const double r = problem.residuals()[i];
    sum += problem.is_seen(i) ? bounded_square(r, cutoff) : r * r;
  }
  return sum;
}

double eased(double damping, double ratio) {
  if (ratio > 0.75) return std::max(1e-9, 0.05 * damping);
  return ratio < 0.25 ? 8 * damping : damping;
}

// Relative to the largest pivot; smaller ones make the matrix singular.
constexpr double rounding = 1e-15;

}  // namespace

double ShapeDescent::cutoff(const ShapeProblem& problem) {
  sizes_.clear();
  for (Eigen::Index i = 0; i < problem.rows(); ++i)
    if (problem.kind(i) == RowKind::point || problem.kind(i) == RowKind::marker)
      sizes_.push_back(std::abs(problem.residuals()[i]));
  if (sizes_.empty()) return uncertain;
  return uncertain * std::max(1.0, median(std::span(sizes_)) / median_size);
}

void ShapeDescent::weigh(const ShapeProblem& problem, double cutoff) {
  weights_.resize(problem.rows());
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    const double ratio = problem.residuals()[i] / cutoff, one = 1 / (1 + ratio * ratio);
    weights_[i] = problem.is_seen(i) ? one * one : 1.0;
  }
  weighted_.noalias() = problem.derivatives().transpose() * weights_.cwiseSqrt().asDiagonal();
  normal_.setZero(weighted_.rows(), weighted_.rows());
  normal_.selfadjointView<Eigen::Lower>().rankUpdate(weighted_);
  gradient_.noalias() = weighted_ * weights_.cwiseSqrt().cwiseProduct(problem.residuals());
}

// Returns false if there is no step.
bool ShapeDescent::find_step(double damping) {
  damped_ = normal_;
  damped_.diagonal() += damping * (normal_.diagonal().array() + 1e-12).matrix();
  solver_.compute(damped_);
  step_ = -gradient_;
  solver_.solve_in_place(step_);
  return step_.allFinite();
}

ShapeFit ShapeDescent::descend(ShapeProblem& problem, const Shape& start, int most_iterations,
                               StartKind kind) {
  const bool is_near = kind == StartKind::near;
  ShapeFit fit;
  fit.shape = start;
  fit.cost = std::numeric_limits<double>::infinity();
  if (!problem.linearise(fit.shape)) return fit;
  double limit = cutoff(problem);
  // At first all points are inliers, however far off the start is; then fewer and fewer distant ones.
  if (!is_near) limit = std::max(limit, 2 * problem.residuals().lpNorm<Eigen::Infinity>());
  weigh(problem, limit);
  // Narrows the limit after a step that reduced the cost by `gain`; returns whether it was the last.
  const auto narrow = [&](double gain, double cost) {
    constexpr double slow = 0.3, narrowing = 0.25;
    const double least = cutoff(problem), scale = limit / uncertain;
    // The step just made was a tenth of a standard deviation: the next one would be a thirtieth.
    fit.is_settled = gain <= 1e-2 * scale * scale && least >= 0.99 * limit;
    if (is_near || gain <= slow * cost)
      limit = std::min(limit, is_near ? least : std::max(narrowing * limit, least));
    weigh(problem, limit);
    return ++fit.iterations >= most_iterations || fit.is_settled;
  };
  Shape there;
  const auto try_step = [&](double damping) -> TriedStep {
    const bool is_step = find_step(damping);
    there = problem.variables().plus(fit.shape, step_);
    if (!is_step || !problem.linearise(there)) return {};
    const auto normal = normal_.selfadjointView<Eigen::Lower>();
    return {cost_of(problem, limit), -step_.dot(2 * gradient_ + normal * step_)};
  };
  const auto keep = [&](const TriedStep& step, double& cost) {
    std::swap(fit.shape, there);
    const bool is_last = narrow(cost - step.cost, cost);
    cost = cost_of(problem, limit);
    return is_last;
  };
  const auto leave = [](const TriedStep&, double) { return false; };
  Damping damping{.start = is_near ? 1e-6 : 1e-3, .rise = 8, .eased = eased};
  while (levenberg_marquardt(cost_of(problem, limit), damping, std::numeric_limits<int>::max(), try_step,
                             keep, leave) == DescentEnd::stuck) {
    (void)problem.linearise(fit.shape);
    // With fewer inliers another step may reduce the cost.
    if (narrow(0, 0)) break;
    damping.start = 1;
  }
  finish(problem, limit, fit);
  return fit;
}

void ShapeDescent::finish(const ShapeProblem& problem, double cutoff, ShapeFit& fit) {
  double square = 0, weight = 0, square_px = 0, inliers = 0, points = 0, far = 0, against = 0,
         predictions = 0, on_axes = 0;
  sizes_.clear();
  std::vector<double> seen_in(problem.observations().size()), inliers_in(seen_in.size());
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    const double r = problem.residuals()[i], px = r * problem.sigma(i);
    if (problem.kind(i) == RowKind::prediction) against += r * r, ++predictions;
    if (!problem.is_seen(i)) continue;
    const RowKind kind = problem.kind(i);
    if (kind == RowKind::point) square += weights_[i] * r * r, weight += weights_[i];
    if (kind == RowKind::end || kind == RowKind::marker) {
      if (std::abs(r) > cutoff) ++fit.contradicted;
      continue;
    }
    ++points, far += bounded_square(px, far_away), ++seen_in[problem.observation(i)];
    if (!(std::abs(r) < cutoff)) continue;
    ++inliers, ++inliers_in[problem.observation(i)];
    if (kind == RowKind::point) ++on_axes, square_px += px * px, sizes_.push_back(r);
  }
  fit.scale = cutoff / uncertain;
  fit.cost = far / std::max(points, 1.0);
  fit.rms = on_axes > 0 ? std::sqrt(square_px / on_axes) : 0.0;
  fit.outlier_share = points > 0 ? 1 - inliers / points : 0.0;
  for (std::size_t i = 0; i < seen_in.size(); ++i)
    fit.outlier_share_in.push_back(seen_in[i] > 0 ? 1 - inliers_in[i] / seen_in[i] : 0.0);
  fit.innovation = std::sqrt(against / std::max(predictions, 1.0));
  // After a belief, the estimate belongs to a filter, which treats points as independent.
  fit.covariance = problem.is_filtered() ? filtered_covariance(problem, square, weight)
                                         : covariance(problem, square, weight);
}

// Inverse of the sum of the previous information and that of the observations, scaled by their residuals.
Eigen::MatrixXd ShapeDescent::filtered_covariance(const ShapeProblem& problem, double square, double weight) {
  const Eigen::Index count = normal_.rows();
  const double freedom = std::max(1.0, weight - static_cast<double>(problem.variables().count()));
  const double variance = std::max(1.0, square / freedom) * correlation_factor(sizes_);
  load_scatter(problem);
  damped_.setZero(count, count);
  damped_.selfadjointView<Eigen::Lower>().rankUpdate(predicted_rows_);
  damped_ += (normal_ - damped_) / variance;
  solver_.compute(damped_);
  if (!solver_.is_definite(rounding))
    return Eigen::MatrixXd::Constant(count, count, std::numeric_limits<double>::infinity());
  return solver_.inverse();
}

// N^-1 (P + f A + max(1, f) S) N^-1, with N the normal matrix and P the prior's information
// (docs/estimation.md, "Uncertainty").
Eigen::MatrixXd ShapeDescent::covariance(const ShapeProblem& problem, double square, double weight) {
  const Eigen::Index count = normal_.rows();
  solver_.compute(normal_);
  if (!solver_.is_definite(rounding))
    return Eigen::MatrixXd::Constant(count, count, std::numeric_limits<double>::infinity());
  damped_ = solver_.inverse();
  load_scatter(problem);
  // With A = G B^T + B G^T and so on: N^-1 G once.
  followed_.noalias() = damped_ * parts_;
  // Degrees of freedom: the fit absorbs part of the residuals' squares.
  const double freedom = std::max(1.0, weight - 2 * followed_.cwiseProduct(alike_).sum());
  // A floor on the precision of axes; beyond it the residuals decide.
  constexpr double least = 0.8;
  const double factor =
      std::max(least, square / freedom) * std::max(1.0, correlation_factor(sizes_) / promised_);
  alike_ = factor * alike_ + std::max(1.0, factor) * apart_;
  scatter_.noalias() = followed_ * alike_.transpose();
  normal_.noalias() = scatter_ * damped_;
  Eigen::MatrixXd result = normal_ + normal_.transpose();
  if (predicted_rows_.cols() > 0) {
    followed_.noalias() = damped_ * predicted_rows_;
    result.noalias() += followed_ * followed_.transpose();
  }
  return result;
}

// Loads the gradient part of each observed row. Also loads the correlated parts of the previous points plus
// half of its own: for the errors of `sigma`, and for all others. Rows of prior and belief are loaded
// unchanged.
void ShapeDescent::load_scatter(const ShapeProblem& problem) {
  // The errors of ends have long tails: tips may be hidden.
  constexpr double of_ends = 2.5;
  Eigen::Index all_seen = 0, all_predicted = 0;
  for (Eigen::Index i = 0; i < problem.rows(); ++i) ++(problem.is_seen(i) ? all_seen : all_predicted);
  const Eigen::Index count = normal_.rows();
  parts_.resize(count, all_seen), alike_.resize(count, all_seen), apart_.resize(count, all_seen);
  predicted_rows_.resize(count, all_predicted);
  std::size_t observation = problem.observations().size(), point = 0;
  double likes = 0, pairs = 0;
  all_seen = all_predicted = 0;
  for (Eigen::Index i = 0; i < problem.rows(); ++i) {
    const auto derivative = problem.derivatives().row(i).transpose();
    if (!problem.is_seen(i)) {
      predicted_rows_.col(all_predicted++) = derivative;
      continue;
    }
    const Eigen::Index k = all_seen++;
    auto part = parts_.col(k), alike = alike_.col(k), apart = apart_.col(k);
    part = weights_[i] * derivative;
    if (problem.kind(i) != RowKind::point) {
      alike.setZero(), apart = (problem.kind(i) == RowKind::end ? 0.5 * of_ends : 0.5) * part;
      continue;
    }
    if (problem.observation(i) != observation) {
      observation = problem.observation(i), point = 0;
      near_.setZero(count), far_.setZero(count);
    }
    const Observation& seen = problem.observations()[observation];
    const CurvePoint& here = seen.points[point];
    if (point > 0) {
      const double way = (here.pixel - seen.points[point - 1].pixel).norm();
      const double like = seen.reach.sigma > 0 ? std::exp(-way / seen.reach.sigma) : 0.0;
      near_ *= like, likes += like, ++pairs;
      if (here.offset > 0) far_ *= std::exp(-way / seen.reach.offset);
    }
    ++point;
    const double offset = here.offset / problem.sigma(i);
    alike = near_ + 0.5 * part;
    apart = offset * (far_ + 0.5 * offset * part);
    near_ += part, far_ += offset * part;
  }
  // As in correlation_factor().
  constexpr double most = 0.95;
  const double like = std::min(likes / std::max(pairs, 1.0), most);
  promised_ = (1 + like) / (1 - like);
}

}  // namespace flexura
