#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Gains of an image-based law.
struct ImageLawGains {
  /// Rate of the errors' decay, 1/s; > 0. With an exact model, errors decay as exp(-rate t).
  double rate = 4;
  /// Damping of the least squares, as a fraction of the RMS singular value of the Jacobian; >= 0.
  double damping = 0.01;
  double most_step = 0.5;  ///< Largest change of the variables per command, rad; > 0.
};

/// Command of a law, and the condition of its Jacobian.
struct ImageStep {
  /// Next command. The command is within the sections' limits; a limiter must check the other limits.
  ArmState asked;
  /// Ratio of the least to the greatest singular value of the Jacobian. The value is a lower bound of the
  /// ratio and, for n variables, at least 1/n of the ratio. Values up to 1e-5 are exact.
  double reciprocal_condition = 0;
  bool is_singular = false;  ///< Whether some motion of the arm changes no feature: the ratio is below 1e-6.
};

/// Moves features to their desired values by damped least squares (docs/control.md, eq. 20; Wampler, 1986;
/// Nakamura, Hanafusa, 1986):
///   dx = -(1 - exp(-rate dt)) (J^T J + mu^2 I)^-1 J^T e.
class ImageLaw {
 public:
  /// Throws std::invalid_argument for numbers that are out of range or not finite, and for an arm without
  /// sections.
  ImageLaw(const Arm& arm, const ImageLawGains& gains);

  /// Returns the variables of the arm: bends (only bend_x for planar arms), and stretches whose limits allow
  /// a change.
  [[nodiscard]] const ArmVariables& variables() const { return variables_; }
  /// Selects the columns of variables() from derivatives with respect to bend_x, bend_y and stretch of every
  /// section.
  [[nodiscard]] Eigen::MatrixXd by_variables(const Eigen::MatrixXd& by_state) const;
  /// Writes these columns into J, which it resizes if needed.
  void by_variables(const Eigen::MatrixXd& by_state, Eigen::MatrixXd& J) const;

  /// Returns the next command. `sent`: last command, dt s before. `error`: measured features minus desired
  /// features. J: derivatives of the features with respect to the variables (by_variables, or an estimate).
  /// The command is within the sections' limits. Throws std::invalid_argument for sizes that do not fit, or
  /// if dt is not positive. Inputs that are not finite give a command that is not finite, at which the
  /// limiter stops the arm.
  [[nodiscard]] ImageStep step(const ArmState& sent, const Eigen::VectorXd& error, const Eigen::MatrixXd& J,
                               double dt) const;

  /// Buffers of step(). Each thread needs separate buffers.
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
