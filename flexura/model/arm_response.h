#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/model/arm.h"

namespace flexura {

/// A mode of an arm's oscillation about its equilibrium. The coordinate z of the mode satisfies z'' + 2
/// damping frequency z' + frequency^2 z = kick . u'', where u is the command.
struct SwingMode {
  double frequency = 0;  ///< Undamped angular frequency, rad/s.
  double damping = 0;    ///< Damping ratio.
  /// Change of bend_x, bend_y and stretch of each arc per unit of z. The largest of these numbers is 1.
  Eigen::VectorXd shape;
  Eigen::VectorXd kick;  ///< Change of z' per change of u', for bend_x, bend_y and stretch of each section.
};

/// Tensions of an arm's tendons.
struct TendonTensions {
  Eigen::VectorXd tensions;  ///< Tensions at the arm's base, N.
  /// Derivatives of the tensions with respect to bend_x, bend_y and stretch of each section.
  Eigen::MatrixXd by_command;
};

/// Computes the shape for a command if the arcs' bends are not fixed shares of their section's bend. An
/// example is an elastic rod with tendons, weight and loads. The shape depends only on the command.
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
  /// Computes the Jacobian of the shape with respect to the command, at a command. The Jacobian has rows
  /// (bend_x, bend_y, stretch) for each arc and columns (bend_x, bend_y, stretch) for each section. Resizes
  /// `by_command` if needed. Entries are NaN if the arm has no equilibrium. Throws std::invalid_argument if
  /// the command does not have one bend and one stretch per section.
  virtual void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const = 0;
  /// Returns the slowest modes of the arm's oscillation about the equilibrium of a command, at most `most`,
  /// in order of increasing frequency. Empty for an arm without dynamics or without an equilibrium. Throws
  /// std::invalid_argument for a command that does not fit the arm.
  [[nodiscard]] virtual std::vector<SwingMode> swing(const ArmState& /*command*/,
                                                     std::size_t /*most*/) const {
    return {};
  }
  /// Returns the tensions of the tendons in the equilibrium of a command. Empty for an arm without tendons or
  /// without an equilibrium. Throws std::invalid_argument for a command that does not fit the arm.
  [[nodiscard]] virtual TendonTensions tensions(const ArmState& /*command*/) const { return {}; }
  /// Returns, for each tendon, the shape for a command under the assumption that this tendon has no tension.
  /// Bends are NaN if the arm then has no equilibrium. Empty for an arm without tendons. Throws
  /// std::invalid_argument for a command that does not fit the arm.
  [[nodiscard]] virtual std::vector<ArmState> released(const ArmState& /*command*/) const { return {}; }
};

}  // namespace flexura
