#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace flexura {

/// Tendon displacements over time, in addition to the displacements that belong to the bends. Each tendon
/// moves to its target at a constant rate, and all arrive at the same time. Like BendMotion, the motion is a
/// function of time and of the commands up to this time.
class PullMotion {
 public:
  /// Starts with all displacements 0. `tendons`: number of tendons. Queries are allowed back to `horizon` s
  /// before the last command.
  PullMotion(std::size_t tendons, double horizon);

  /// Commands a motion to `target`, m, that begins at `time`, s, and ends at `end`, s. If `end` is not after
  /// `time`, the motion is immediate. `time` must not be before the last command.
  void command(double time, std::vector<double> target, double end);
  /// Commands a motion of all tendons back to 0. Times are as for command().
  void back(double time, double end);
  void halt(double time);

  /// Adds the displacement of each tendon to `pulled`, m.
  void add_to(std::vector<double>& pulled, double time) const;

 private:
  struct Plan {
    double start = 0, end = 0;
    std::vector<double> from, to;
  };
  std::size_t tendons_;
  double horizon_;
  std::deque<Plan> plans_;  // Ordered by start; before the first plan all tendons are at 0.
};

}  // namespace flexura
