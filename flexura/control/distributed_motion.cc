#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "flexura/control/distributed_arm.h"

namespace flexura {
namespace {

// Returns the second derivatives of V_g + V_e at one point by (theta, q, theta_s, q_s, stretch).
Eigen::Matrix<double, 5, 5> stiffness_at(const DistributedArmModel& model, double weight, double weigh,
                                         const Eigen::Vector4d& angles, double stretch) {
  const double a = std::cos(angles[0]), b = std::sin(angles[0]), c = std::cos(angles[1]),
               d = std::sin(angles[1]);
  const double theta_s = angles[2], q_s = angles[3];
  const Eigen::Vector3d e(b * c, a * c, d), e_theta(a * c, -b * c, 0), e_q(-b * d, -a * d, c);
  const Eigen::Vector3d& g = model.gravity;
  const double k = model.bending_stiffness * weight / stretch;
  Eigen::Matrix<double, 5, 5> H = Eigen::Matrix<double, 5, 5>::Zero();
  H(0, 0) = -weigh * stretch * g.dot(Eigen::Vector3d(-b * c, -a * c, 0));
  H(1, 0) = -weigh * stretch * g.dot(Eigen::Vector3d(-a * d, b * d, 0));
  H(1, 1) = weigh * stretch * g.dot(e) - k * (c * c - d * d) * theta_s * theta_s;
  H(2, 1) = -2 * k * c * d * theta_s;
  H(2, 2) = k * c * c;
  H(3, 3) = k;
  H(4, 0) = -weigh * g.dot(e_theta);
  H(4, 1) = -weigh * g.dot(e_q) + k / stretch * c * d * theta_s * theta_s;
  H(4, 2) = -k / stretch * c * c * theta_s;
  H(4, 3) = -k / stretch * q_s;
  H(4, 4) =
      k / (stretch * stretch) * (q_s * q_s + c * c * theta_s * theta_s) + model.axial_stiffness * weight;
  return H.selfadjointView<Eigen::Lower>();
}

}  // namespace

Eigen::MatrixXd DistributedArm::stiffness() const {
  const Eigen::Index n = nodes();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size_, size_), by_x = Eigen::MatrixXd::Zero(5, size_);
  for (Eigen::Index j = 0; j < theta_.size(); ++j) {
    const std::size_t section = shapes_.section[static_cast<std::size_t>(j)];
    const auto k = static_cast<Eigen::Index>(section);
    by_x.row(0).head(n) = by_x.row(1).segment(n, n) = shapes_.values.row(j);
    by_x.row(2).head(n) = by_x.row(3).segment(n, n) = shapes_.slopes.row(j);
    if (model_.has_variable_lengths) {
      by_x.row(4).setZero();
      by_x(4, lengths_at_ + k) = 1 / model_.lengths[section];
    }
    K += by_x.transpose() *
         stiffness_at(model_, shapes_.weights[j], weigh_[j], {theta_[j], q_[j], theta_s_[j], q_s_[j]},
                      stretch_[k]) *
         by_x;
  }
  return K;
}

DistributedMotion::DistributedMotion(DistributedArm arm, Force force, const OdeTolerance& tolerance)
    : arm_(std::move(arm)), force_(std::move(force)), ode_(2 * arm_.size() + 2, tolerance) {
  Q_.setZero(arm_.size()), acceleration_.setZero(arm_.size());
  start(Eigen::VectorXd::Zero(arm_.size()));
}

void DistributedMotion::start(const Eigen::VectorXd& x) {
  time_ = 0;
  x_ = x, v_ = Eigen::VectorXd::Zero(x.size());
  y_.setZero(2 * x.size() + 2);
  y_.head(x.size()) = x;
  arm_.set(x_, v_);
}

void DistributedMotion::slope(double t, const Eigen::VectorXd& y, Eigen::VectorXd& slope) {
  const Eigen::Index n = arm_.size();
  x_ = y.head(n), v_ = y.segment(n, n);
  arm_.set(x_, v_);
  const double power = force_(t, arm_, x_, v_, Q_);
  if (!arm_.accelerate(Q_, acceleration_))  // The step is rejected.
    acceleration_.setConstant(std::numeric_limits<double>::quiet_NaN());
  slope.head(n) = v_, slope.segment(n, n) = acceleration_;
  slope[2 * n] = arm_.damping_power(), slope[2 * n + 1] = power;
}

bool DistributedMotion::advance(double until, const std::function<bool()>& go_on) {
  const auto progress =
      ode_.advance([this](double t, const Eigen::VectorXd& y, Eigen::VectorXd& to) { slope(t, y, to); },
                   time_, y_, until, [&] { return !go_on || go_on(); });
  x_ = y_.head(arm_.size()), v_ = y_.segment(arm_.size(), arm_.size());
  arm_.set(x_, v_);
  return progress.is_there;
}

}  // namespace flexura
