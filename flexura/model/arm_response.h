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

/// Tensions of an arm's tendons.
struct TendonTensions {
  Eigen::VectorXd tensions;    ///< At the arm's base, N.
  Eigen::MatrixXd by_command;  ///< Their derivatives by (bend_x, bend_y, stretch) of each section.
};

/// Computes the shape for a command if the arcs' bends are not fixed shares of their section's bend. An
/// example is an elastic rod under tendons, weight and loads. The shape depends on the command alone.
/// Thread-safe.
class ArmResponse {
 public:
  ArmResponse() = default;
  ArmResponse(const ArmResponse&) = delete;
  ArmResponse& operator=(const ArmResponse&) = delete;
  virtual ~ArmResponse() = default;

  /// Returns the shape for a command. The shape has one bend and one stretch per arc; bends are NaN if the
  /// arm has no equilibrium. Throws std::invalid_argument if the command does not have one bend and one
  /// stretch per section.
  [[nodiscard]] virtual ArmState shape(const ArmState& command) const = 0;
  /// Computes the Jacobian of the shape with respect to the command, at a command. It has rows (bend_x,
  /// bend_y, stretch) for each arc and columns (bend_x, bend_y, stretch) for each section. Resizes
  /// `by_command` if needed. Entries are NaN if the arm has no equilibrium. Throws std::invalid_argument if
  /// the command does not have one bend and one stretch per section.
  virtual void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const = 0;
  /// Returns the slowest modes in which the arm swings about the equilibrium of a command, at most `most`, in
  /// order of their frequencies. Empty for an arm that follows its commands without swinging, or without an
  /// equilibrium. Throws std::invalid_argument for a command of another arm.
  [[nodiscard]] virtual std::vector<SwingMode> swing(const ArmState& /*command*/,
                                                     std::size_t /*most*/) const {
    return {};
  }
  /// Returns the tensions of the tendons in the equilibrium of a command. Empty for an arm without tendons or
  /// without an equilibrium. Throws std::invalid_argument for a command of another arm.
  [[nodiscard]] virtual TendonTensions tensions(const ArmState& /*command*/) const { return {}; }
  /// Returns, for each tendon, the shape for a command if this tendon had no tension. Bends are NaN if the
  /// arm then has no equilibrium. Empty for an arm without tendons. Throws std::invalid_argument for a
  /// command of another arm.
  [[nodiscard]] virtual std::vector<ArmState> released(const ArmState& /*command*/) const { return {}; }
};

}  // namespace flexura
