#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/model/arm.h"

namespace flexura {

/// How a law of images goes about it.
struct ImageLawGains {
  double rate = 4;         ///< Errors fall as exp(-rate t) where the model is right, 1/s; > 0.
  double damping = 0.01;   ///< Of the least squares, share of the Jacobian's root mean square gain; >= 0.
  double most_step = 0.5;  ///< The longest step of the variables at a time, rad; > 0.
};

/// What a law asks for, and how sure its Jacobian is of it.
struct ImageStep {
  ArmState asked;  ///< To be sent next, through a limiter; within the sections' limits.
  /// Least over greatest singular value of the Jacobian: of n variables never more than that and at least an
  /// n-th of it, and just that where it is 1e-5 or less.
  double reciprocal_condition = 0;
  bool is_singular = false;  ///< Some motion of the arm shows in no feature: the ratio is below 1e-6.
};

/// Steers features to their desired values by damped least squares (docs/control.md, eq. 20; C. W. Wampler,
/// 1986; Y. Nakamura, H. Hanafusa, 1986):
///   dx = -(1 - exp(-rate dt)) (J^T J + mu^2 I)^-1 J^T e.
class ImageLaw {
 public:
  /// std::invalid_argument: numbers out of their ranges or not finite, an arm without sections.
  ImageLaw(const Arm& arm, const ImageLawGains& gains);

  /// What the arm may change: bends, of planar arms bend_x alone, and stretches whose limits leave them free.
  [[nodiscard]] const ArmVariables& variables() const { return variables_; }
  /// The columns of a derivative by (bend_x, bend_y, stretch) of every section that belong to these.
  [[nodiscard]] Eigen::MatrixXd by_variables(const Eigen::MatrixXd& by_state) const;
  /// The same, into what is made to fit.
  void by_variables(const Eigen::MatrixXd& by_state, Eigen::MatrixXd& J) const;

  /// Where to send an arm that was last sent to `sent`, dt s later. `error`: features seen less desired; J:
  /// their derivatives by the variables (by_variables, or an estimate's). Within the sections' limits.
  /// std::invalid_argument: sizes that do not fit, dt not positive. Numbers that are not finite come out as
  /// such, for the limiter to stop at.
  [[nodiscard]] ImageStep step(const ArmState& sent, const Eigen::VectorXd& error, const Eigen::MatrixXd& J,
                               double dt) const;

  /// What a step works on: one for each thread.
  struct Work {
    Eigen::MatrixXd normal, factor;  // J^T J, its lower triangle; Cholesky's of that.
    Eigen::VectorXd x, dx, column;
  };
  /// The same, without allocation once `work` and `step` have served, unless J is nearly singular.
  void step(const ArmState& sent, const Eigen::VectorXd& error, const Eigen::MatrixXd& J, double dt,
            Work& work, ImageStep& step) const;

 private:
  ArmVariables variables_;
  ImageLawGains gains_;
};

}  // namespace flexura
