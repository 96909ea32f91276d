#pragma once

#include <cstddef>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/tube.h"

namespace flexura {

/// The arm in the middle of an interval of time, and how far it may come from there (docs/safety.md).
class Swing {
 public:
  /// An arm at rest.
  Swing(const Arm& arm, const ArmState& state);
  /// Of a motion that knows its rates.
  Swing(const Arm& arm, const Motion& motion, const Span& span);

  /// Whether the state in the middle is possible; without, there are no tubes.
  [[nodiscard]] bool is_possible() const { return !tubes_.empty(); }
  [[nodiscard]] const std::vector<SectionTube>& tubes() const { return tubes_; }

 private:
  friend class Chain;

  std::vector<SectionTube> tubes_;  // in the middle
  std::vector<double> turn_;        // of each section: change of its bend, rad
  std::vector<double> length_;      // the longest it gets, m
  std::vector<double> stretch_;     // change of its length, m
};

/// Sections that follow each other, from `first` to `last`: how far the last one may move in the frame of any
/// point of the first one, and which pairs of points of the two are no neighbours.
class Chain {
 public:
  /// The swing must outlive it.
  Chain(const Swing& swing, std::size_t first);

  /// Goes on to section `last`, which is not before the present one, or starts anew at `first` to do so.
  void go_to(std::size_t first, std::size_t last);

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t last() const { return last_; }
  [[nodiscard]] const SectionTube& first_tube() const { return swing_->tubes_[first_]; }
  [[nodiscard]] const SectionTube& last_tube() const { return swing_->tubes_[last_]; }
  /// How far the last section's end may move, m.
  [[nodiscard]] double moved() const { return moved_; }
  /// The last section's tube made thicker (sign 1) or thinner (-1) by a `share` of what it may move.
  [[nodiscard]] SectionTube grown(double sign, double share = 1) const;
  /// Which pairs of points to ask of, given what may change: all that may count (sign -1), or those that
  /// surely do (1).
  [[nodiscard]] PairRule rule(double sign) const;
  /// Whether any do.
  [[nodiscard]] bool has_pairs(const PairRule& rule) const;
  /// A distance between the two sections' tubes that is surely there, in the middle.
  [[nodiscard]] double apart() const;

 private:
  void restart(std::size_t first);
  void add(std::size_t section);

  const Swing* swing_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  double moved_before_ = 0;  // the end before the last section, m
  double moved_ = 0;
  double turned_ = 0;                                 // how much the turn up to there may change, rad
  double sharpest_ = 0;                               // least radius of curvature, m
  double thinnest_ = 0;                               // of the radii, m
  double stretched_ = 0;                              // how much the length may change, m
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();  // of the first section
};

}  // namespace flexura
