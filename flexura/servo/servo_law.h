#pragma once

#include <Eigen/Core>
#include <optional>

#include "flexura/control/image_law.h"
#include "flexura/model/actuation.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_model.h"
#include "flexura/servo/drive_response.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_goals.h"
#include "flexura/servo/servo_observation.h"

namespace flexura {

/// Computes the arm's next command from observations, by damped least squares on the features of a law
/// (docs/servo.md).
class ServoLaw {
 public:
  /// `features` and `config` must outlive this object.
  ServoLaw(const ArmModel& nominal, const ServoConfig& config, ServoFeatures& features);

  /// Input of a step.
  struct Input {
    const ServoObservation& observed;  ///< Last observation of the arm.
    bool is_fresh = false;             ///< Whether the observation is new since the last step.
    const ArmState& measured;          ///< Measured position of the drives at the time of the observation.
    const ArmState& sent;              ///< The last command.
    const TargetShape& then;           ///< Target at the time of the observation.
    const TargetShape& desired;        ///< Current target.
    const ArmState& next;              ///< Target one step later.
  };
  struct Output {
    ArmState asked;
    double potential = 0;  ///< Half the squared feature error at the time of the observation.
    bool is_singular = false;
  };
  /// Returns the next command. Returns the last command if no error can be computed from the observation.
  [[nodiscard]] Output step(const Input& input);

 private:
  // Converts derivatives with respect to the shape to derivatives with respect to the law's variables at a
  // command.
  void by_variables(const Eigen::MatrixXd& by_shape, const ArmState& command, Eigen::MatrixXd& J);
  // Writes the variables of a command into x. They need not be within the limits.
  void pack(const ArmState& state, Eigen::VectorXd& x) const;
  // Computes the measured features into seen_.
  [[nodiscard]] bool find_features(const ServoObservation& observed);
  // Computes the error of the measured features, and writes the features to seen_.
  [[nodiscard]] bool find_error(const Input& input, const TargetShape& desired, FeatureError& result);
  // Adds the motion of the drives that follows the target's motion.
  void go_along(const ArmState& desired, const ArmState& next, ArmState& asked);

  const ServoConfig& config_;
  ServoFeatures& features_;
  Actuation actuation_;
  ImageLaw law_;
  DriveResponse response_;
  // Buffers of a step, kept to avoid allocations.
  // Of the last moving target: its next shape, and the command of that shape.
  std::optional<ArmState> next_;
  ArmState next_command_;
  Eigen::VectorXd seen_, desired_, x_, y_;
  ArmState halfway_;
  FeatureError is_, was_;
  Eigen::MatrixXd by_command_, by_shape_, J_;
  ImageLaw::Work work_;
  ImageStep step_;
};

}  // namespace flexura
