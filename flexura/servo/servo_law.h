#pragma once

#include <Eigen/Core>

#include "flexura/control/image_law.h"
#include "flexura/model/actuation.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_model.h"
#include "flexura/servo/drive_response.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_goals.h"
#include "flexura/servo/servo_sight.h"

namespace flexura {

/// Where to send the arm, by what was seen of it: damped least squares on the features of a law
/// (docs/servo.md).
class ServoLaw {
 public:
  /// `features` and `config` outlive it.
  ServoLaw(const ArmModel& believed, const ServoConfig& config, ServoFeatures& features);

  /// What it goes by.
  struct Input {
    const ServoSight& sight;    ///< The last one in which the arm was seen.
    bool is_fresh = false;      ///< It was not there at the last step.
    const ArmState& said;       ///< What the drives said at its time.
    const ArmState& sent;       ///< The last command.
    const WantedShape& then;    ///< What was wanted at the sight's time,
    const WantedShape& wanted;  ///< is wanted now,
    const ArmState& next;       ///< and one step from now.
  };
  struct Wish {
    ArmState asked;
    double potential = 0;  ///< Half the error's square at the sight's time.
    bool is_singular = false;
  };
  /// Asks to stay where nothing can be told from the sight.
  [[nodiscard]] Wish step(const Input& input);

 private:
  // The derivatives by what the law varies, at a command, from those by the shape.
  void by_variables(const Eigen::MatrixXd& by_shape, const ArmState& command, Eigen::MatrixXd& J);
  // The variables of a command, within the limits or not.
  void pack(const ArmState& state, Eigen::VectorXd& x) const;
  // Of what is seen, in seen_.
  [[nodiscard]] bool find_error(const Input& input, const WantedShape& wanted, FeatureError& result);
  // What the drives do while what is wanted goes on.
  void go_along(const ArmState& wanted, const ArmState& next, ArmState& asked);

  const ServoConfig& config_;
  ServoFeatures& features_;
  Actuation actuation_;
  ImageLaw law_;
  DriveResponse response_;
  // What a step works on, kept so that none allocates it anew.
  Eigen::VectorXd seen_, desired_, x_, y_;
  ArmState halfway_;
  FeatureError is_, was_;
  Eigen::MatrixXd by_command_, by_shape_, J_;
  ImageLaw::Work work_;
  ImageStep step_;
};

}  // namespace flexura
