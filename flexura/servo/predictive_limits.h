#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/control/predictive_law.h"
#include "flexura/model/arm_model.h"
#include "flexura/safety/contact_watch.h"
#include "flexura/servo/servo_config.h"

namespace flexura {

/// Limits of a predictive servo besides bends and rates, linear about the present command: tensions that the
/// motors can hold, clearances from obstacles and of the arm from itself, and the borders of the pictures
/// (docs/control.md, "Predictive law").
class PredictiveLimits {
 public:
  PredictiveLimits(ArmModel model, const ServoConfig& config);

  /// Returns the limits. `sent`: last command. `rest`: shape that the arm has at rest under it. `by_command`:
  /// derivative of this shape with respect to the command. `views`: of the two cameras.
  [[nodiscard]] std::vector<PredictiveLimit> find(const ArmState& sent, const ArmState& rest,
                                                  const Eigen::MatrixXd& by_command,
                                                  const std::array<View, 2>& views) const;

 private:
  void add_tensions(const ArmState& sent, std::vector<PredictiveLimit>& limits) const;
  void add_clearances(const ArmState& rest, const Eigen::MatrixXd& by_command,
                      std::vector<PredictiveLimit>& limits) const;
  void add_borders(const ArmState& rest, const Eigen::MatrixXd& by_command, const View& view,
                   std::vector<PredictiveLimit>& limits) const;

  ArmModel model_;
  std::vector<double> most_tension_;    // Of each tendon, N; may be infinite.
  std::vector<ContactWatch> contacts_;  // Of the shape.
  bool keeps_view_;
};

}  // namespace flexura
