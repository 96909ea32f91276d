#pragma once

#include <cstddef>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/tube.h"

namespace flexura {

/// The arm's state in the middle of a time interval, and bounds on the motion from this state within the
/// interval (docs/safety.md).
class Swing {
 public:
  /// Constructor for an arm at rest in a state.
  Swing(const Arm& arm, const ArmState& state);
  /// Constructor for an arm during `span` of a motion with known bounds on its rates.
  Swing(const Arm& arm, const Motion& motion, const Span& span);

  /// Returns whether the state in the middle is possible; otherwise there are no tubes.
  [[nodiscard]] bool is_possible() const { return !tubes_.empty(); }
  [[nodiscard]] const std::vector<SectionTube>& tubes() const { return tubes_; }

 private:
  friend class Chain;

  std::vector<SectionTube> tubes_;  // Tubes in the middle of the interval.
  std::vector<double> turn_;        // Largest change of each section's bend, rad.
  std::vector<double> length_;      // Largest length of each section, m.
  std::vector<double> stretch_;     // Largest change of each section's length, m.
};

/// A chain of consecutive sections from `first` to `last`. Computes bounds on the motion of the last section
/// relative to any point of the first section. Also determines which pairs of points of the two sections are
/// not neighbours.
class Chain {
 public:
  /// `swing` must outlive this object.
  Chain(const Swing& swing, std::size_t first);

  /// Extends the chain to section `last`. Restarts the chain at `first` if it begins at another section, or
  /// if `last` is before its last section.
  void go_to(std::size_t first, std::size_t last);

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t last() const { return last_; }
  [[nodiscard]] const SectionTube& first_tube() const { return swing_->tubes_[first_]; }
  [[nodiscard]] const SectionTube& last_tube() const { return swing_->tubes_[last_]; }
  /// Returns a bound on the motion of the last section's end, m.
  [[nodiscard]] double moved() const { return moved_; }
  /// Returns the last section's tube with its radius increased (sign 1) or decreased (sign -1) by `share`
  /// times the section's possible motion.
  [[nodiscard]] SectionTube grown(double sign, double share = 1) const;
  /// Returns the rule for pairs of points that takes the possible motion into account. With sign -1, the rule
  /// selects all pairs that may have to be considered. With sign 1, the rule selects only the pairs that
  /// certainly must be considered.
  [[nodiscard]] PairRule rule(double sign) const;
  /// Returns whether the rule includes any pair of points.
  [[nodiscard]] bool has_pairs(const PairRule& rule) const;
  /// Returns a lower bound on the distance between the tubes of the first and the last section in the middle
  /// of the interval, m.
  [[nodiscard]] double apart() const;

 private:
  void restart(std::size_t first);
  void add(std::size_t section);

  const Swing* swing_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  double moved_before_ = 0;  // Bound on the motion of the last section's start, m.
  double moved_ = 0;
  double turned_ = 0;                                 // Bound on the change of the chain's turn, rad.
  double sharpest_ = 0;                               // Smallest radius of curvature, m.
  double thinnest_ = 0;                               // Smallest tube radius, m.
  double stretched_ = 0;                              // Bound on the change of the chain's length, m.
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();  // Middle of the first section.
};

}  // namespace flexura
