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

/// Limits of a predictive servo in addition to those of bends and rates, linearised about the present
/// command. These limits restrict tensions to what the motors can hold, keep the arm clear of obstacles and
/// of itself, and keep it within the pictures (docs/control.md, "Predictive law").
class PredictiveLimits {
 public:
  PredictiveLimits(ArmModel model, const ServoConfig& config);

  /// Returns the limits. `sent`: last command. `rest`: shape of the arm at rest under this command.
  /// `by_command`: derivative of `rest` with respect to the command. `views`: views of the two cameras.
  [[nodiscard]] std::vector<PredictiveLimit> find(const ArmState& sent, const ArmState& rest,
                                                  const Eigen::MatrixXd& by_command,
                                                  const std::array<View, 2>& views) const;

 private:
  void add_tensions(const ArmState& sent, std::vector<PredictiveLimit>& limits) const;
  void add_clearances(const ArmState& rest, const Eigen::MatrixXd& by_command,
                      std::vector<PredictiveLimit>& limits) const;
  void add_borders(const ArmState& rest, const Eigen::MatrixXd& by_command, std::size_t camera,
                   const View& view, std::vector<PredictiveLimit>& limits) const;

  ArmModel model_;
  std::vector<double> most_tension_;    // Of each tendon, N; may be infinite.
  std::vector<ContactWatch> contacts_;  // Of the shape.
  bool keeps_view_;
};

}  // namespace flexura
