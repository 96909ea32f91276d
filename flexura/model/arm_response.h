#pragma once

#include <Eigen/Core>

#include "flexura/model/arm.h"

namespace flexura {

/// Computes the shape for a command if the arcs' bends are not fixed shares of their section's bend. An
/// example is an elastic rod under tendons, weight and loads. The shape depends on the command alone.
/// Thread-safe.
class ArmResponse {
 public:
  ArmResponse() = default;
  ArmResponse(const ArmResponse&) = delete;
  ArmResponse& operator=(const ArmResponse&) = delete;
  virtual ~ArmResponse() = default;

  /// Returns the shape for a command, one bend and one stretch per arc. Bends are NaN if the arm has no
  /// equilibrium. Throws std::invalid_argument if the command does not have one bend and one stretch per
  /// section.
  [[nodiscard]] virtual ArmState shape(const ArmState& command) const = 0;
  /// Computes the Jacobian of the shape with respect to the command, at a command. It has rows (bend_x,
  /// bend_y, stretch) for each arc and columns (bend_x, bend_y, stretch) for each section. Resizes
  /// `by_command` if needed. Entries are NaN if the arm has no equilibrium. Throws std::invalid_argument if
  /// the command does not have one bend and one stretch per section.
  virtual void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const = 0;
};

}  // namespace flexura
