#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/control/distributed_arm.h"

namespace flexura {

/// What an artificial potential does about the arm's own elasticity.
enum class ElasticityRule : std::uint8_t {
  cancelled,  ///< The law adds dV_e/dx.
  shaped,     ///< V_e is part of the potential, tilted so that its slope at the target is zero.
  ignored,    ///< Neither: the condition of the theory is violated, unless elasticity is at rest at the
              ///< target (nothing bent or stretched); then it is shaped already.
};

/// Numbers of the law. The defaults for what the theory demands are its own; others violate it, for showing
/// what happens then.
struct PotentialGains {
  Eigen::Vector2d stiffness = {20, 20};  ///< k of theta and q, N m a length (m) and rad; > 0.
  Eigen::Matrix2d damping = 4 * Eigen::Matrix2d::Identity();  ///< K of (theta, q), N m s a length; positive.
  double length_stiffness = 200;                              ///< Of each u_i, N/m; > 0.
  double length_damping = 40;                                 ///< N s/m; > 0.
  double gravity_share = 1;                                   ///< Of dV_g/dx that is compensated.
  ElasticityRule elasticity = ElasticityRule::cancelled;      ///< What is done about dV_e/dx.
  double sign = 1;  ///< Of the potential's force; -1 drives away from the target.
};

/// The paper's law for a distributed arm (section 2 with its sources; docs/control.md, eq. 9):
///   F = -dPi/dx + dV_g/dx - K dx/dt,
///   Pi = 1/2 int (k_theta (theta - theta_d)^2 + k_q (q - q_d)^2) ds + 1/2 k_u sum (u - u_d)^2,
/// as generalized forces on the coordinates of a DistributedArm. Where its conditions hold, W = T + Pi falls:
/// dW/dt = -int (theta_t, q_t) K (theta_t, q_t) ds - the arm's own damping.
class PotentialLaw {
 public:
  /// For arms like `arm`, towards the coordinates `target`. std::invalid_argument: numbers that are not
  /// finite, a target of another size.
  PotentialLaw(const DistributedArm& arm, Eigen::VectorXd target, const PotentialGains& gains);

  /// Which conditions of the theory do not hold, in words; empty where W falls.
  [[nodiscard]] std::vector<std::string> violations() const;

  /// The generalized forces Q on an arm in the state (x, v), to which it is set.
  void force(const DistributedArm& arm, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
             Eigen::VectorXd& Q) const;
  /// The same with the errors (measured less desired) of theta and q as they were seen at the arm's points
  /// shapes().s, rad; lengths by x.
  void force_of_errors(const DistributedArm& arm, const Eigen::VectorXd& e_theta, const Eigen::VectorXd& e_q,
                       const Eigen::VectorXd& x, const Eigen::VectorXd& v, Eigen::VectorXd& Q) const;

  /// Pi of the arm in the state x to which it is set, J; with a shaped elasticity V_e is in it.
  [[nodiscard]] double potential(const DistributedArm& arm, const Eigen::VectorXd& x) const;
  /// int (theta_t, q_t) K (theta_t, q_t) ds + k sum u_t^2: what the law takes, W.
  [[nodiscard]] double dissipation(const Eigen::VectorXd& v) const { return v.dot(damping_ * v); }

  /// The coordinates that the law leads to.
  [[nodiscard]] const Eigen::VectorXd& target() const { return target_; }
  /// As they count: an elasticity that is ignored and at rest at the target is `shaped`.
  [[nodiscard]] const PotentialGains& gains() const { return gains_; }

 private:
  void compensate(const DistributedArm& arm, const Eigen::VectorXd& v, Eigen::VectorXd& Q) const;

  PotentialGains gains_;
  Eigen::VectorXd target_;
  bool has_lengths_ = false;
  Eigen::MatrixXd stiffness_, damping_;  // Of the coordinates.
  Eigen::VectorXd elastic_at_target_;    // dV_e/dx there, N m
  double elastic_energy_at_target_ = 0;  // J
  Eigen::MatrixXd stiffness_at_target_;  // The Hessian of V_g + V_e there.
  Eigen::MatrixXd gravity_stiffness_;    // That of V_g alone.
};

}  // namespace flexura
