#pragma once

#include <cstddef>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/tube.h"

namespace flexura {

/// The arm in the middle of a time interval, and its largest possible motion from there (docs/safety.md).
class Swing {
 public:
  /// An arm at rest.
  Swing(const Arm& arm, const ArmState& state);
  /// A motion with known rates.
  Swing(const Arm& arm, const Motion& motion, const Span& span);

  /// Returns true if the state in the middle is possible; otherwise there are no tubes.
  [[nodiscard]] bool is_possible() const { return !tubes_.empty(); }
  [[nodiscard]] const std::vector<SectionTube>& tubes() const { return tubes_; }

 private:
  friend class Chain;

  std::vector<SectionTube> tubes_;  // In the middle.
  std::vector<double> turn_;        // Change of each section's bend, rad.
  std::vector<double> length_;      // Largest length of each section, m.
  std::vector<double> stretch_;     // Change of each section's length, m.
};

/// Consecutive sections from `first` to `last`. Computes the possible motion of the last one in the frame of
/// any point of the first one, and the pairs of their points that are not neighbours.
class Chain {
 public:
  /// The swing must outlive this object.
  Chain(const Swing& swing, std::size_t first);

  /// Extends the chain to section `last`. Restarts at `first` if that is another section or `last` is before
  /// the current one.
  void go_to(std::size_t first, std::size_t last);

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t last() const { return last_; }
  [[nodiscard]] const SectionTube& first_tube() const { return swing_->tubes_[first_]; }
  [[nodiscard]] const SectionTube& last_tube() const { return swing_->tubes_[last_]; }
  /// Returns the largest possible motion of the last section's end, m.
  [[nodiscard]] double moved() const { return moved_; }
  /// Returns the last section's tube, made thicker (sign 1) or thinner (-1) by a `share` of its possible
  /// motion.
  [[nodiscard]] SectionTube grown(double sign, double share = 1) const;
  /// Returns the rule for pairs of points under the possible changes: all that may count (sign -1), or those
  /// that surely do (1).
  [[nodiscard]] PairRule rule(double sign) const;
  /// Returns true if any pair counts.
  [[nodiscard]] bool has_pairs(const PairRule& rule) const;
  /// Returns a lower bound on the distance between the two sections' tubes in the middle, m.
  [[nodiscard]] double apart() const;

 private:
  void restart(std::size_t first);
  void add(std::size_t section);

  const Swing* swing_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  double moved_before_ = 0;  // Motion of the end before the last section, m.
  double moved_ = 0;
  double turned_ = 0;                                 // Change of the turn up to there, rad.
  double sharpest_ = 0;                               // Least radius of curvature, m.
  double thinnest_ = 0;                               // Least tube radius, m.
  double stretched_ = 0;                              // Change of the length, m.
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();  // Middle of the first section.
};

}  // namespace flexura
