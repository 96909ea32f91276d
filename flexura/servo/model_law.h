#pragma once

#include <optional>
#include <string>

#include "flexura/control/modal_law.h"
#include "flexura/control/predictive_law.h"
#include "flexura/model/arm_model.h"
#include "flexura/servo/predictive_limits.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_goals.h"
#include "flexura/servo/shape_observer.h"

namespace flexura {

/// Laws of a servo that predict the arm's motion, including its oscillation, with a model.
class ModelLaw {
 public:
  /// predicts_motion(config.law) must be true.
  ModelLaw(const ArmModel& model, const ServoConfig& config);

  /// Time of a step by the rig's clock, and since the servo's start, s.
  struct Times {
    double now = 0, since_start = 0;
  };
  /// Returns the law's command for the next step, based on the last observation. `sent` and `before`: the
  /// last two commands.
  [[nodiscard]] ArmState command(const Times& times, const ArmState& sent, const ArmState& before,
                                 const ShapeObserver& observer, const ServoGoals& goals);
  /// Returns which limit of the law restricted the last command, in addition to those of bends and rates; ""
  /// if none did.
  [[nodiscard]] const std::string& limit() const { return limit_; }

 private:
  ArmModel model_;
  double step_;
  int horizon_;
  std::optional<PredictiveLaw> predictive_;
  std::optional<ModalLaw> modal_;
  PredictiveLimits limits_;
  std::string limit_;
};

}  // namespace flexura
