#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/model/arm.h"

namespace flexura {

/// What drives are believed to make of an arm: from commands, one bend and one stretch a section, to shapes,
/// one bend and one stretch an arc, and back. A section may be several arcs, each of which takes its share of
/// the bend (Section::bend_profile) and all of the stretch, so both ways are linear.
class Actuation {
 public:
  /// The identity: shapes are commands, of however many sections (of which it counts none).
  Actuation() = default;
  /// std::invalid_argument: a profile that is empty, not finite, negative, or of zeros alone.
  explicit Actuation(const Arm& driven);

  /// Numbers of sections and of arcs.
  [[nodiscard]] std::size_t sections() const { return sections_; }
  [[nodiscard]] std::size_t arcs() const { return shares_.size(); }
  /// Whether every section is one arc: then shapes are commands.
  [[nodiscard]] bool is_one_to_one() const { return sections_ == shares_.size(); }
  /// Whose arc one is, for each.
  [[nodiscard]] const std::vector<std::size_t>& section_of() const { return section_of_; }
  /// How much of that section's bend is the arc's, of 1.
  [[nodiscard]] double share_of(std::size_t arc) const { return shares_[arc]; }
  /// The same where each arc bends by a factor more; none are all 1. std::invalid_argument: another number.
  [[nodiscard]] Actuation with_gains(const std::vector<double>& gains) const;

  /// The shape that a command makes. std::invalid_argument: of another arm.
  [[nodiscard]] ArmState shape(const ArmState& command) const;
  /// The command whose shape is nearest: least squares over the arcs of each section. Likewise.
  [[nodiscard]] ArmState command(const ArmState& shape) const;
  /// From derivatives by a shape, three columns an arc (bend_x, bend_y, stretch), to those by a command,
  /// three columns a section: into what is made to fit. std::invalid_argument: other columns.
  void by_command(const Eigen::MatrixXd& by_shape, Eigen::MatrixXd& by_command) const;

 private:
  std::size_t sections_ = 0;
  // Of each arc.
  std::vector<std::size_t> section_of_;
  std::vector<double> shares_;
};

/// The arm whose sections are the arcs of another's, as `actuation` has them. Limits on bends are the
/// drives': of a section of several arcs these have none.
[[nodiscard]] Arm shaped_arm(const Arm& driven, const Actuation& actuation);

}  // namespace flexura
