#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/arm_response.h"

namespace flexura {

/// Model of an arm's drives: converts commands, one bend and one stretch per section, to shapes, one bend and
/// one stretch per arc, and back. A section may be several arcs.
///
/// Each arc has its share of the section's bend (Section::bend_profile) and all of its stretch, so both
/// conversions are linear. Or an ArmResponse computes the shape, as of a rod, and the profile has a factor on
/// each arc's bend.
class Actuation {
 public:
  /// The identity: shapes are commands, with any number of sections (sections() is 0).
  Actuation() = default;
  /// Throws std::invalid_argument if a profile is empty, not finite, negative, or all zeros.
  explicit Actuation(const Arm& driven);
  /// For an arm with this response, with one arc per number of its sections' profiles. Throws
  /// std::invalid_argument if a profile is invalid.
  Actuation(const Arm& driven, std::shared_ptr<const ArmResponse> response);

  /// Return the numbers of sections and of arcs.
  [[nodiscard]] std::size_t sections() const { return sections_; }
  [[nodiscard]] std::size_t arcs() const { return shares_.size(); }
  /// Returns true if shapes are commands: every section is one arc, which bends as commanded.
  [[nodiscard]] bool is_identity() const { return !response_ && sections_ == shares_.size(); }
  /// Returns true if there is no response, only shares.
  [[nodiscard]] bool is_linear() const { return !response_; }
  /// Returns the section of each arc.
  [[nodiscard]] const std::vector<std::size_t>& section_of() const { return section_of_; }
  /// Returns the arc's share of that section's bend, of 1; with a response, the factor on the arc's bend.
  [[nodiscard]] double share_of(std::size_t arc) const { return shares_[arc]; }
  /// Returns the actuation with each arc's bend multiplied by a gain; empty gains are all 1. Throws
  /// std::invalid_argument unless there is one gain per arc.
  [[nodiscard]] Actuation with_gains(const std::vector<double>& gains) const;

  /// Returns the shape for a command; NaN if a response has none. Throws std::invalid_argument for a command
  /// of another arm.
  [[nodiscard]] ArmState shape(const ArmState& command) const;
  /// Returns the command with the nearest shape: least squares over the arcs' bends. With a response, the one
  /// with the same total bend per section, as nearly as correction steps find it. Throws
  /// std::invalid_argument for a shape of another arm.
  [[nodiscard]] ArmState command(const ArmState& shape) const;
  /// Computes the derivative of the shape's (bend_x, bend_y, stretch) by the command's, 3 arcs x 3 sections,
  /// at a command. Resizes `by_command` if needed. Throws std::invalid_argument for a command of another arm.
  void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const;
  /// Returns the slowest modes in which the arm swings about the equilibrium of a command (ArmResponse::swing);
  /// empty without a response.
  [[nodiscard]] std::vector<SwingMode> swing(const ArmState& command, std::size_t most) const;
  /// Converts derivatives by a shape, three columns per arc (bend_x, bend_y, stretch), to those by a command,
  /// three columns per section, at this command. Resizes `by_command` if needed. Throws std::invalid_argument
  /// for another number of columns.
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

/// Returns the arm whose sections are the arcs of `driven`, by `actuation`. Limits on bends are of the
/// drives: arcs of a section have none, unless the section simply bends as commanded.
[[nodiscard]] Arm shaped_arm(const Arm& driven, const Actuation& actuation);

}  // namespace flexura
