#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "flexura/control/image_law.h"
#include "flexura/control/jacobian_estimate.h"
#include "flexura/model/arm.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/servo_goals.h"
#include "flexura/servo/servo_session.h"

namespace flexura {

/// Where to send the arm, by what was seen of it: damped least squares on the features of a law
/// (docs/servo.md).
class ServoLaw {
 public:
  /// `features` and `config` outlive it.
  ServoLaw(const Arm& arm, const ServoConfig& config, ServoFeatures& features);

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
  void learn(const Eigen::VectorXd& seen, const ArmState& said, const Eigen::MatrixXd& model);

  const ServoConfig& config_;
  ServoFeatures& features_;
  ImageLaw law_;
  std::variant<std::monostate, BroydenEstimate, RecursiveEstimate> learned_;
  std::optional<Eigen::VectorXd> x_before_, f_before_;
  Eigen::MatrixXd J_;
  ImageLaw::Work work_;
};

}  // namespace flexura
