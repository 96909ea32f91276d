#include "flexura/control/jacobian_estimate.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

void require_numbers(bool are_good, const Eigen::MatrixXd& J) {
  if (!are_good || J.size() == 0 || !J.allFinite())
    throw std::invalid_argument("a Jacobian estimate needs finite initial numbers in their ranges");
}

bool teaches(const Eigen::MatrixXd& J, const Eigen::VectorXd& dx, const Eigen::VectorXd& df, double least) {
  if (dx.size() != J.cols() || df.size() != J.rows())
    throw std::invalid_argument("a motion's size does not fit the Jacobian estimate");
  return dx.allFinite() && df.allFinite() && dx.norm() >= least;
}

}  // namespace

BroydenEstimate::BroydenEstimate(Eigen::MatrixXd J, double share, double least)
    : J_(std::move(J)), share_(share), least_(least) {
  require_numbers(share > 0 && share <= 1 && least > 0 && std::isfinite(least), J_);
}

bool BroydenEstimate::learn(const Eigen::VectorXd& dx, const Eigen::VectorXd& df) {
  if (!teaches(J_, dx, df, least_)) return false;
  const Eigen::VectorXd missed = df - J_ * dx;
  J_.noalias() += share_ / dx.squaredNorm() * missed * dx.transpose();
  return true;
}

RecursiveEstimate::RecursiveEstimate(Eigen::MatrixXd J, double forgetting, double max_variance, double least)
    : J_(std::move(J)), forgetting_(forgetting), max_variance_(max_variance), least_(least) {
  require_numbers(forgetting > 0 && forgetting <= 1 && max_variance > 0 && std::isfinite(max_variance) &&
                      least > 0 && std::isfinite(least),
                  J_);
  P_ = max_variance * Eigen::MatrixXd::Identity(J_.cols(), J_.cols());
}

bool RecursiveEstimate::learn(const Eigen::VectorXd& dx, const Eigen::VectorXd& df) {
  if (!teaches(J_, dx, df, least_)) return false;
  const Eigen::VectorXd seen = P_ * dx;
  const Eigen::VectorXd gain = seen / (forgetting_ + dx.dot(seen));
  const Eigen::VectorXd missed = df - J_ * dx;
  J_.noalias() += missed * gain.transpose();
  P_ -= (gain * seen.transpose()).eval();
  P_ /= forgetting_;
  // Keeps the matrix symmetric despite rounding, and limits its growth at rest.
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  const double most = P_.diagonal().maxCoeff();
  if (most > max_variance_) P_ *= max_variance_ / most;
  return true;
}

}  // namespace flexura
