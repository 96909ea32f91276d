#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace flexura {

/// Tendon displacements in addition to those of the bends. Each tendon moves to its target at constant rate,
/// and all arrive together. Like BendMotion, it is a function of time and of the commands up to that time.
class PullMotion {
 public:
  /// Starts with `tendons` tendons at 0. Queries are allowed back to `horizon` s before the last command.
  PullMotion(std::size_t tendons, double horizon);

  /// Moves from `time` s on to `target`, m, and reaches it at `end` s, or at once if `end` has passed. `time`
  /// is not before the last command.
  void command(double time, std::vector<double> target, double end);
  /// Moves all tendons back to 0, with times as for command().
  void back(double time, double end);
  void halt(double time);

  /// Adds the displacement of each tendon, m.
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
