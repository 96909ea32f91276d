#include "flexura/servo/drive_response.h"

#include <Eigen/Core>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

// Dead zone, rad. Observations of smaller motions are as much noise as motion, so motions add up until they
// exceed it.
constexpr double least = 0.03;
constexpr double share = 0.5, forgetting = 0.97, max_variance = 300;
// Largest residual learned per rad of motion, rad. It limits the effect of an outlier.
constexpr double most_missed = 1;

}  // namespace

DriveResponse::DriveResponse(ServoJacobian how, Eigen::Index variables)
    : identity_(Eigen::MatrixXd::Identity(variables, variables)) {
  if (how == ServoJacobian::broyden) estimate_ = BroydenEstimate(identity_, share, least);
  if (how == ServoJacobian::recursive)
    estimate_ = RecursiveEstimate(identity_, forgetting, max_variance, least);
}

const Eigen::MatrixXd& DriveResponse::matrix() const {
  if (const auto* broyden = std::get_if<BroydenEstimate>(&estimate_)) return broyden->jacobian();
  if (const auto* recursive = std::get_if<RecursiveEstimate>(&estimate_)) return recursive->jacobian();
  return identity_;
}

void DriveResponse::learn(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  if (!is_learned() || !x.allFinite() || !y.allFinite()) return;
  if (before_) {
    dx_ = x - before_->x;
    const double motion = dx_.norm();
    if (motion < least) return;
    predicted_.noalias() = matrix() * dx_;
    missed_ = y - before_->y - predicted_;
    const double missed = missed_.norm();
    if (missed > most_missed * motion) missed_ *= most_missed * motion / missed;
    predicted_ += missed_;
    if (auto* broyden = std::get_if<BroydenEstimate>(&estimate_)) (void)broyden->learn(dx_, predicted_);
    if (auto* recursive = std::get_if<RecursiveEstimate>(&estimate_)) (void)recursive->learn(dx_, predicted_);
    before_->x = x, before_->y = y;
  } else {
    before_ = Seen{x, y};
  }
}

Eigen::VectorXd DriveResponse::drives_for(const Eigen::VectorXd& dy) const {
  if (!is_learned()) return dy;
  constexpr double damping = 1e-4;
  const Eigen::MatrixXd& C = matrix();
  const Eigen::MatrixXd normal = C.transpose() * C + damping * identity_;
  return Cholesky(normal).solve(C.transpose() * dy);
}

}  // namespace flexura
