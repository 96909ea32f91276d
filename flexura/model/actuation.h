#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/arm_response.h"

namespace flexura {

/// What drives are believed to make of an arm: from commands, one bend and one stretch a section, to shapes,
/// one bend and one stretch an arc, and back. A section may be several arcs.
///
/// Each arc takes its share of the section's bend (Section::bend_profile) and all of its stretch, so that
/// both ways are linear; or an ArmResponse computes the shape, as of a rod, and the profile has a factor on
/// each arc's bend.
class Actuation {
 public:
  /// The identity: shapes are commands, of however many sections (of which it counts none).
  Actuation() = default;
  /// std::invalid_argument: a profile that is empty, not finite, negative, or of zeros alone.
  explicit Actuation(const Arm& driven);
  /// Of an arm that responds so, one arc for each number of its sections' profiles. Errors as above.
  Actuation(const Arm& driven, std::shared_ptr<const ArmResponse> response);

  /// Numbers of sections and of arcs.
  [[nodiscard]] std::size_t sections() const { return sections_; }
  [[nodiscard]] std::size_t arcs() const { return shares_.size(); }
  /// Whether shapes are commands: every section is one arc, which bends as it is commanded.
  [[nodiscard]] bool is_identity() const { return !response_ && sections_ == shares_.size(); }
  /// Whether shares are all there is to it.
  [[nodiscard]] bool is_linear() const { return !response_; }
  /// Whose arc one is, for each.
  [[nodiscard]] const std::vector<std::size_t>& section_of() const { return section_of_; }
  /// How much of that section's bend is the arc's, of 1; of a response, by what factor the arc bends more.
  [[nodiscard]] double share_of(std::size_t arc) const { return shares_[arc]; }
  /// The same where each arc bends by a factor more; none are all 1. std::invalid_argument: another number.
  [[nodiscard]] Actuation with_gains(const std::vector<double>& gains) const;

  /// The shape that a command makes; NaN where a response has none. std::invalid_argument: of another arm.
  [[nodiscard]] ArmState shape(const ArmState& command) const;
  /// The command whose shape is nearest: least squares over the arcs' bends. Of a response the one by which
  /// each section bends as much in all, as nearly as steps by what is missing find it. Likewise.
  [[nodiscard]] ArmState command(const ArmState& shape) const;
  /// The derivative of the shape's (bend_x, bend_y, stretch) by the command's, 3 arcs x 3 sections, at a
  /// command: into what is made to fit. Likewise.
  void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const;
  /// From derivatives by a shape, three columns an arc (bend_x, bend_y, stretch), to those by a command,
  /// three columns a section, at this one: into what is made to fit. std::invalid_argument: other columns.
  void by_command(const Eigen::MatrixXd& by_shape, const ArmState& command,
                  Eigen::MatrixXd& by_command) const;

 private:
  [[nodiscard]] ArmState linear_command(const ArmState& shape) const;

  std::size_t sections_ = 0;
  // Of each arc.
  std::vector<std::size_t> section_of_;
  std::vector<double> shares_;
  std::shared_ptr<const ArmResponse> response_;
};

/// The arm whose sections are the arcs of another's, as `actuation` has them. Limits on bends are the
/// drives': of a section that does not simply bend as it is commanded its arcs have none.
[[nodiscard]] Arm shaped_arm(const Arm& driven, const Actuation& actuation);

}  // namespace flexura
