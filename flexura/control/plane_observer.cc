#include "flexura/control/plane_observer.h"

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "flexura/control/plane_errors.h"
#include "flexura/math/dense.h"

namespace flexura {

PlaneObserver::PlaneObserver(const DistributedArm& arm, const Eigen::VectorXd& target,
                             const std::array<double, 2>& noise)
    : noise_(noise) {
  DistributedArm there = arm;
  there.set(target, Eigen::VectorXd::Zero(arm.size()));
  theta_d_ = there.theta(), q_d_ = there.q();
  const AngleShapes& shapes = arm.shapes();
  const std::array<double, 2> clamp = arm.model().clamp.value_or(std::array<double, 2>{0, 0});
  clamped_theta_ = clamp[0] * shapes.base, clamped_q_ = clamp[1] * shapes.base;
  const Eigen::MatrixXd weighted = shapes.values.transpose() * shapes.weights.asDiagonal();
  fit_ = PivotedCholesky(weighted * shapes.values).solve(weighted);
  theta_ = q_ = e_theta_ = e_q_ = Eigen::VectorXd::Zero(shapes.s.size());
}

void PlaneObserver::look(const DistributedArm& arm, const Eigen::VectorXd& x,
                         const std::function<double(std::uint64_t)>& deviate) {
  const Eigen::Index points = theta_.size(), n = arm.nodes();
  for (Eigen::Index j = 0; j < points; ++j) {
    const double off_1 = noise_[0] * deviate(static_cast<std::uint64_t>(j)),
                 off_2 = noise_[1] * deviate(static_cast<std::uint64_t>(points + j));
    PlaneView seen = plane_view(arm.theta()[j], arm.q()[j]), desired = plane_view(theta_d_[j], q_d_[j]);
    seen.alpha_1 += off_1, seen.alpha_2 += off_2;
    // Azimuths continue beyond half a turn; the other plane's angles do not.
    desired.alpha_2 = seen.alpha_2 - std::remainder(seen.alpha_2 - desired.alpha_2, 2 * std::numbers::pi);
    const PlaneError error = plane_error(seen, desired);
    if (!planes_contradict(seen) && planes_determine({error.theta, error.q}, {theta_d_[j], q_d_[j]})) {
      theta_[j] = error.theta, q_[j] = error.q;
      e_theta_[j] = error.e_theta, e_q_[j] = error.e_q;
      ++determined_;
    } else {
      theta_[j] = arm.theta()[j] + off_1, q_[j] = arm.q()[j] + off_2;
      e_theta_[j] = theta_[j] - theta_d_[j], e_q_[j] = q_[j] - q_d_[j];
      ++undetermined_;
    }
  }
  coordinates_ = x;
  coordinates_.head(n) = fit_ * (theta_ - clamped_theta_);
  coordinates_.segment(n, n) = fit_ * (q_ - clamped_q_);
}

double PlaneObserver::triangulated() const {
  const double all = determined_ + undetermined_;
  return all > 0 ? undetermined_ / all : 0;
}

}  // namespace flexura
