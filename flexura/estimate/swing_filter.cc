#include "flexura/estimate/swing_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/math/dense.h"
#include "flexura/math/oscillator.h"

namespace flexura {
namespace {

// Bounds of the logarithms of the factors on the frequencies.
constexpr double most_detuned = 0.7;
constexpr double least_part = 1e-12;

// Returns the motion over a path from `start`.
Eigen::VectorXd moved(const std::vector<SwingMode>& modes, const SwingPath& path,
                      const Eigen::VectorXd& start) {
  const auto count = static_cast<Eigen::Index>(modes.size());
  Eigen::VectorXd x = start;
  for (const SwingPath::Part& part : path.parts) {
    for (Eigen::Index j = 0; j < count; ++j) {
      const SwingMode& mode = modes[static_cast<std::size_t>(j)];
      const double factor = std::exp(x[2 * count + j]);
      // Stiffness damps in proportion to the frequency.
      const Eigen::Matrix2d F = oscillation(factor * mode.frequency, factor * mode.damping, part.duration);
      const Eigen::Vector2d after = F * Eigen::Vector2d(x[j], x[count + j] + part.kicks[j]);
      x[j] = after[0], x[count + j] = after[1];
    }
  }
  return x;
}

Eigen::MatrixXd shapes_of(const std::vector<SwingMode>& modes) {
  Eigen::MatrixXd shapes(modes.front().shape.size(), static_cast<Eigen::Index>(modes.size()));
  for (std::size_t j = 0; j < modes.size(); ++j) shapes.col(static_cast<Eigen::Index>(j)) = modes[j].shape;
  return shapes;
}

// Derivative of the motion over a path by its start, by central differences.
Eigen::MatrixXd motion_slopes(const std::vector<SwingMode>& modes, const SwingPath& path,
                              const Eigen::VectorXd& start) {
  constexpr double step = 1e-5;
  Eigen::MatrixXd F(start.size(), start.size());
  for (Eigen::Index c = 0; c < start.size(); ++c) {
    Eigen::VectorXd more = start, less = start;
    more[c] += step, less[c] -= step;
    F.col(c) = (moved(modes, path, more) - moved(modes, path, less)) / (2 * step);
  }
  return F;
}

}  // namespace

void SwingFilter::forget() {
  modes_.clear();
  mean_.resize(0);
  covariance_.resize(0, 0);
  cross_.resize(0, 0);
}

Eigen::VectorXd SwingFilter::frequency_factors() const {
  return mean_.tail(static_cast<Eigen::Index>(modes_.size())).array().exp();
}

Eigen::VectorXd SwingFilter::predict(const SwingPath& path, Eigen::Index bends, Eigen::MatrixXd& covariance) {
  const auto count = static_cast<Eigen::Index>(path.modes.size()), unknowns = 3 * count;
  if (path.modes.size() != modes_.size() || cross_.rows() != covariance.rows()) {
    forget();
    if (count == 0) return {};
    mean_ = Eigen::VectorXd::Zero(unknowns);
    covariance_ = Eigen::MatrixXd::Zero(unknowns, unknowns);
    auto of_factors = covariance_.bottomRightCorner(count, count);
    of_factors.setConstant(config_.frequency_error * config_.frequency_error);
    of_factors.diagonal().array() += config_.mode_frequency_error * config_.mode_frequency_error;
    cross_ = Eigen::MatrixXd::Zero(covariance.rows(), unknowns);
  } else {
    // The modes of another shape are others: z and z' go to those that change the arm alike, and so do the
    // factors.
    const Eigen::MatrixXd turn = pseudo_inverse(shapes_of(path.modes)) * shapes_of(modes_);
    Eigen::MatrixXd parts = turn.array().square();
    for (Eigen::Index j = 0; j < count; ++j) parts.row(j) /= std::max(parts.row(j).sum(), least_part);
    Eigen::MatrixXd T = Eigen::MatrixXd::Zero(unknowns, unknowns);
    T.topLeftCorner(count, count) = turn;
    T.block(count, count, count, count) = turn;
    T.bottomRightCorner(count, count) = parts;
    mean_ = (T * mean_).eval();
    covariance_ = (T * covariance_ * T.transpose()).eval();
    cross_ = (cross_ * T.transpose()).eval();
  }
  modes_ = path.modes;
  double time = 0;
  for (const SwingPath::Part& part : path.parts) time += part.duration;
  for (Eigen::Index j = 0; j < count; ++j) {
    double variance = config_.force_noise * config_.force_noise * time;
    for (const SwingPath::Part& part : path.parts)
      variance += config_.kick_error * config_.kick_error * part.kicks[j] * part.kicks[j];
    covariance_(count + j, count + j) += variance;
  }
  covariance_.diagonal().tail(count).array() += config_.frequency_noise * config_.frequency_noise * time;

  const Eigen::MatrixXd F = motion_slopes(modes_, path, mean_), shapes = shapes_of(modes_);
  const Eigen::VectorXd after = moved(modes_, path, mean_);
  Eigen::VectorXd change = shapes * (after - mean_).head(count);
  // The other unknowns move by the change of the shape.
  Eigen::MatrixXd slope = shapes * F.topRows(count);
  slope.leftCols(count) -= shapes;
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(covariance.rows(), mean_.size());
  for (Eigen::Index arc = 0; 3 * arc < slope.rows(); ++arc)
    G.middleRows(bends * arc, bends) = slope.middleRows(3 * arc, bends);
  const Eigen::MatrixXd common = cross_ * G.transpose();
  covariance += G * covariance_ * G.transpose() + common + common.transpose();
  cross_ = ((cross_ + G * covariance_) * F.transpose()).eval();
  covariance_ = (F * covariance_ * F.transpose()).eval();
  mean_ = after;
  return change;
}

void SwingFilter::update(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& predicted,
                         const Eigen::MatrixXd& estimated, bool is_update) {
  if (!is_tracked()) return;
  const Eigen::MatrixXd spread = is_update ? predicted : Eigen::MatrixXd(predicted + estimated);
  const Eigen::MatrixXd gain = PivotedCholesky(spread).solve(cross_).transpose();
  if (innovation.size() != cross_.rows() || !gain.allFinite() || !innovation.allFinite()) {
    forget();
    return;
  }
  mean_ += gain * innovation;
  const auto count = static_cast<Eigen::Index>(modes_.size());
  mean_.tail(count) = mean_.tail(count).cwiseMax(-most_detuned).cwiseMin(most_detuned).eval();
  if (is_update)
    covariance_ -= gain * (predicted - estimated) * gain.transpose();
  else
    covariance_ -= gain * cross_;
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  cross_ = (estimated * gain.transpose()).eval();
}

Eigen::VectorXd SwingFilter::shape() const {
  if (!is_tracked()) return {};
  return shapes_of(modes_) * mean_.head(static_cast<Eigen::Index>(modes_.size()));
}

Eigen::VectorXd SwingFilter::after(const SwingPath& path) const {
  if (!is_tracked()) return {};
  return moved(modes_, path, mean_).head(2 * static_cast<Eigen::Index>(modes_.size()));
}

}  // namespace flexura
