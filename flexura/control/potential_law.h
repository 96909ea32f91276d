#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/control/distributed_arm.h"

namespace flexura {

/// How an artificial potential handles the arm's elasticity.
enum class ElasticityRule : std::uint8_t {
  cancelled,  ///< The law adds dV_e/dx.
  shaped,  ///< V_e is part of the potential. A linear term makes the potential's gradient at the target zero.
  /// The law neglects V_e. This violates a condition of the theory, unless the target has no bend and no
  /// stretch: then the elastic forces vanish at the target, and `ignored` counts as `shaped`.
  ignored,
};

/// Gains of the law. The defaults satisfy the conditions of the theory. Other values may violate these
/// conditions, so that tests and studies can show the effects.
struct PotentialGains {
  Eigen::Vector2d stiffness = {20, 20};  ///< k_theta and k_q, N m per length (m) and rad; > 0.
  Eigen::Matrix2d damping =
      4 * Eigen::Matrix2d::Identity();  ///< K of (theta, q), N m s per length (m); positive definite.
  double length_stiffness = 200;        ///< k_u of each u_i, N/m; > 0.
  double length_damping = 40;           ///< Damping of each u_i, N s/m; > 0.
  double gravity_share = 1;             ///< Compensated share of dV_g/dx.
  ElasticityRule elasticity = ElasticityRule::cancelled;  ///< Handling of dV_e/dx.
  double sign = 1;  ///< Sign of the potential's force; -1 moves away from the target.
};

/// The paper's law for a distributed arm (its section 2 and the sources cited there; docs/control.md, eq. 9):
///   F = -dPi/dx + dV_g/dx - K dx/dt,
///   Pi = 1/2 int (k_theta (theta - theta_d)^2 + k_q (q - q_d)^2) ds + 1/2 k_u sum (u - u_d)^2.
/// F has the generalized forces on the coordinates of a DistributedArm. If the conditions of the theory hold,
/// W = T + Pi decreases: dW/dt = -int (theta_t, q_t) K (theta_t, q_t) ds, minus the power of the arm's own
/// damping.
class PotentialLaw {
 public:
  /// Makes a law for arms that have the model of `arm`. `target`: coordinates of the target. Throws
  /// std::invalid_argument for numbers that are not finite, and for a target whose size does not fit the arm.
  PotentialLaw(const DistributedArm& arm, Eigen::VectorXd target, const PotentialGains& gains);

  /// Returns the violated conditions of the theory in words. If the list is empty, W decreases for certain.
  [[nodiscard]] std::vector<std::string> violations() const;

  /// Computes the generalized forces Q on an arm that is set to the state (x, v).
  void force(const DistributedArm& arm, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
             Eigen::VectorXd& Q) const;
  /// Computes the forces from measured errors (measured minus desired) of theta and q at the points
  /// arm.shapes().s, rad. Computes the errors of lengths from x.
  void force_of_errors(const DistributedArm& arm, const Eigen::VectorXd& e_theta, const Eigen::VectorXd& e_q,
                       const Eigen::VectorXd& x, const Eigen::VectorXd& v, Eigen::VectorXd& Q) const;

  /// Returns Pi of an arm that is set to the state x, J. Pi includes V_e if elasticity is shaped.
  [[nodiscard]] double potential(const DistributedArm& arm, const Eigen::VectorXd& x) const;
  /// Returns the power removed by the law, W: int (theta_t, q_t) K (theta_t, q_t) ds + k sum u_t^2.
  [[nodiscard]] double dissipation(const Eigen::VectorXd& v) const { return v.dot(damping_ * v); }

  /// Returns the target coordinates.
  [[nodiscard]] const Eigen::VectorXd& target() const { return target_; }
  /// Returns the gains that the law uses. `elasticity` is `shaped` instead of `ignored` if elastic forces
  /// vanish at the target.
  [[nodiscard]] const PotentialGains& gains() const { return gains_; }

 private:
  void compensate(const DistributedArm& arm, const Eigen::VectorXd& v, Eigen::VectorXd& Q) const;

  PotentialGains gains_;
  Eigen::VectorXd target_;
  bool has_lengths_ = false;
  Eigen::MatrixXd stiffness_, damping_;  // Matrices for the coordinates.
  Eigen::VectorXd elastic_at_target_;    // dV_e/dx at the target, N m.
  double elastic_energy_at_target_ = 0;  // V_e at the target, J.
  Eigen::MatrixXd stiffness_at_target_;  // The Hessian of V_g + V_e at the target.
  Eigen::MatrixXd gravity_stiffness_;    // The Hessian of V_g alone.
};

}  // namespace flexura
