#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/arm_response.h"

namespace flexura {

/// Converts between commands and shapes of an arm. A command has one bend and one stretch per section; a
/// shape has one bend and one stretch per arc. A section consists of one or more arcs.
///
/// Without an ArmResponse, each arc has its share of the section's bend (Section::bend_profile) and the
/// section's stretch. The conversions between command and shape are then linear. With an ArmResponse, for
/// example of an elastic rod, the response computes the shape. The numbers of the profile are then factors on
/// the arcs' computed bends.
class Actuation {
 public:
  /// Identity for any number of sections: the shape equals the command. sections() is 0.
  Actuation() = default;
  /// Uses the bend profiles of `driven`. Throws std::invalid_argument if a profile is empty or all zeros, or
  /// has a number that is negative or not finite.
  explicit Actuation(const Arm& driven);
  /// Uses `response` for the arm `driven`, with one arc for each number of the sections' profiles. Throws
  /// std::invalid_argument if a profile is invalid.
  Actuation(const Arm& driven, std::shared_ptr<const ArmResponse> response);

  /// The number of sections, and the number of arcs.
  [[nodiscard]] std::size_t sections() const { return sections_; }
  [[nodiscard]] std::size_t arcs() const { return shares_.size(); }
  /// Returns whether the shape equals the command: every section is one arc that bends as commanded.
  [[nodiscard]] bool is_identity() const { return !response_ && sections_ == shares_.size(); }
  /// Returns whether there is no ArmResponse, so that both conversions are linear.
  [[nodiscard]] bool is_linear() const { return !response_; }
  /// Returns, for each arc, the index of the section that contains the arc.
  [[nodiscard]] const std::vector<std::size_t>& section_of() const { return section_of_; }
  /// Returns the arc's fraction of its section's bend. With a response, returns the factor on the arc's
  /// computed bend.
  [[nodiscard]] double share_of(std::size_t arc) const { return shares_[arc]; }
  /// Returns this actuation with each arc's bend multiplied by a gain. Empty `gains` mean 1 for all arcs.
  /// Throws std::invalid_argument if `gains` is not empty and does not have one number per arc.
  [[nodiscard]] Actuation with_gains(const std::vector<double>& gains) const;

  /// Returns the shape for a command. Bends are NaN if the response has no equilibrium for this command.
  /// Throws std::invalid_argument if the command does not have one bend and one stretch per section.
  [[nodiscard]] ArmState shape(const ArmState& command) const;
  /// Returns the command whose shape is nearest to `shape`, by least squares over the arcs' bends. With a
  /// response, iterative correction finds the command that gives each section approximately the same total
  /// bend as `shape`. Throws std::invalid_argument if the shape does not have one bend and one stretch per
  /// arc.
  [[nodiscard]] ArmState command(const ArmState& shape) const;
  /// Computes the Jacobian of the shape with respect to the command, at a command. The Jacobian has rows
  /// (bend_x, bend_y, stretch) for each arc and columns (bend_x, bend_y, stretch) for each section. Resizes
  /// `by_command` if needed. Throws std::invalid_argument if the command does not have one bend and one
  /// stretch per section.
  void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const;
  /// Returns the slowest modes of the arm's oscillation about the equilibrium of a command
  /// (ArmResponse::swing); empty without a response.
  [[nodiscard]] std::vector<SwingMode> swing(const ArmState& command, std::size_t most) const;
  /// Returns the tensions of the tendons for a command (ArmResponse::tensions); empty without a response.
  [[nodiscard]] TendonTensions tensions(const ArmState& command) const {
    return response_ ? response_->tensions(command) : TendonTensions();
  }
  /// Returns, for each tendon, the shape for a command under the assumption that this tendon has no tension
  /// (ArmResponse::released). Empty without a response.
  [[nodiscard]] std::vector<ArmState> released(const ArmState& command) const;
  /// Converts derivatives with respect to the shape to derivatives with respect to the command, at `command`.
  /// `by_shape` has three columns per arc (bend_x, bend_y, stretch), `by_command` three per section. Resizes
  /// `by_command` if needed. Throws std::invalid_argument if `by_shape` has a wrong number of columns.
  void by_command(const Eigen::MatrixXd& by_shape, const ArmState& command,
                  Eigen::MatrixXd& by_command) const;

 private:
  [[nodiscard]] ArmState linear_command(const ArmState& shape) const;

  std::size_t sections_ = 0;
  // Per arc.
  std::vector<std::size_t> section_of_;
  std::vector<double> shares_;
  std::shared_ptr<const ArmResponse> response_;
};

/// Returns the arm with one section for each arc of `actuation`, the actuation of `driven`. The bend limits
/// of `driven` apply to commands. Hence an arc has no bend limit, unless its section is one arc that bends as
/// commanded.
[[nodiscard]] Arm shaped_arm(const Arm& driven, const Actuation& actuation);

}  // namespace flexura
