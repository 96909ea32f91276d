#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Gains of an image-based law.
struct ImageLawGains {
  double rate = 4;         ///< Errors decay as exp(-rate t) if the model is right, 1/s; > 0.
  double damping = 0.01;   ///< Damping of the least squares, as a share of the Jacobian's rms gain; >= 0.
  double most_step = 0.5;  ///< Largest step of the variables per command, rad; > 0.
};

/// Command of a law, and the condition of its Jacobian.
struct ImageStep {
  ArmState asked;  ///< Next command, to be checked by a limiter; within the sections' limits.
  /// Ratio of the least to the greatest singular value of the Jacobian. The value is a lower bound of the
  /// ratio, at least 1/n of it for n variables. It is exact if it is 1e-5 or less.
  double reciprocal_condition = 0;
  bool is_singular = false;  ///< Some motion of the arm changes no feature: the ratio is below 1e-6.
};

/// Moves features to their desired values by damped least squares (docs/control.md, eq. 20; C. W. Wampler,
/// 1986; Y. Nakamura, H. Hanafusa, 1986):
///   dx = -(1 - exp(-rate dt)) (J^T J + mu^2 I)^-1 J^T e.
class ImageLaw {
 public:
  /// Throws std::invalid_argument for numbers out of their ranges or not finite, or an arm without sections.
  ImageLaw(const Arm& arm, const ImageLawGains& gains);

  /// Returns the variables of the arm: bends (of planar arms bend_x only), and stretches that are not fixed
  /// by their limits.
  [[nodiscard]] const ArmVariables& variables() const { return variables_; }
  /// Returns the columns of these variables from a derivative with respect to (bend_x, bend_y, stretch) of
  /// every section.
  [[nodiscard]] Eigen::MatrixXd by_variables(const Eigen::MatrixXd& by_state) const;
  /// Computes these columns into J, which it resizes if needed.
  void by_variables(const Eigen::MatrixXd& by_state, Eigen::MatrixXd& J) const;

  /// Returns the command for an arm that was last commanded to `sent`, dt s later. `error`: measured features
  /// minus desired ones. J: derivatives of the features with respect to the variables (by_variables, or an
  /// estimate). The command is within the sections' limits. Throws std::invalid_argument for sizes that do
  /// not fit, or if dt is not positive. Inputs that are not finite give a command that is not finite, at
  /// which the limiter stops the arm.
  [[nodiscard]] ImageStep step(const ArmState& sent, const Eigen::VectorXd& error, const Eigen::MatrixXd& J,
                               double dt) const;

  /// Buffers of a step: one per thread.
  struct Work {
    Eigen::MatrixXd normal, factor;  // Lower triangle of J^T J; Cholesky factor of it.
    Eigen::VectorXd x, dx, column;
  };
  /// Computes the step without allocation after the first use of `work` and `step`, unless J is nearly
  /// singular.
  void step(const ArmState& sent, const Eigen::VectorXd& error, const Eigen::MatrixXd& J, double dt,
            Work& work, ImageStep& step) const;

 private:
  ArmVariables variables_;
  ImageLawGains gains_;
};

}  // namespace flexura
