#pragma once

#include <Eigen/Core>

#include "flexura/model/arm.h"

namespace flexura {

/// Shapes for commands of an arm whose sections do not simply share their bends out, such as a rod under
/// tendons, weight and loads. A function of the command alone; thread-safe.
class ArmResponse {
 public:
  ArmResponse() = default;
  ArmResponse(const ArmResponse&) = delete;
  ArmResponse& operator=(const ArmResponse&) = delete;
  virtual ~ArmResponse() = default;

  /// Returns the shape for a command, one bend and one stretch per arc. Bends are NaN if the arm has no
  /// equilibrium. Throws std::invalid_argument for a command of another arm.
  [[nodiscard]] virtual ArmState shape(const ArmState& command) const = 0;
  /// Computes the derivative of the shape's (bend_x, bend_y, stretch) by the command's, 3 arcs x 3 sections.
  /// Resizes `by_command` if needed. NaN if the arm has no equilibrium. Throws std::invalid_argument for a
  /// command of another arm.
  virtual void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const = 0;
};

}  // namespace flexura
