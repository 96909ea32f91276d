#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/model/arm.h"

namespace flexura {

/// A mode in which an arm swings about its equilibrium. Its coordinate z has z'' + 2 damping frequency z' +
/// frequency^2 z = kick . u'', where u is the command.
struct SwingMode {
  double frequency = 0;   ///< Undamped, rad/s.
  double damping = 0;     ///< Damping ratio.
  Eigen::VectorXd shape;  ///< Change of (bend_x, bend_y, stretch) of each arc by z; the largest number is 1.
  Eigen::VectorXd kick;   ///< Change of z' by a change of u', per (bend_x, bend_y, stretch) of each section.
};

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
  /// Returns the slowest modes in which the arm swings about the equilibrium of a command, at most `most`, in
  /// order of their frequencies. Empty for an arm that follows its commands without swinging, or without an
  /// equilibrium. Throws std::invalid_argument for a command of another arm.
  [[nodiscard]] virtual std::vector<SwingMode> swing(const ArmState& /*command*/,
                                                     std::size_t /*most*/) const {
    return {};
  }
};

}  // namespace flexura
