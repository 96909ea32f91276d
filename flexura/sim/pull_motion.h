#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace flexura {

/// How far tendons are pulled in beside what bends pull in: each goes straight to its target, and all arrive
/// together. A function of time and of the commands up to then, as BendMotion is.
class PullMotion {
 public:
  /// So many, at 0; asked for times back to `horizon` s before the last command.
  PullMotion(std::size_t tendons, double horizon);

  /// From `time` s, not before the last command, to `target`, m, which is reached at `end` s, or at once
  /// where that is over.
  void command(double time, std::vector<double> target, double end);
  /// Likewise to 0.
  void back(double time, double end);
  void halt(double time);

  /// Adds where each is, m.
  void add_to(std::vector<double>& pulled, double time) const;

 private:
  struct Plan {
    double start = 0, end = 0;
    std::vector<double> from, to;
  };
  std::size_t tendons_;
  double horizon_;
  std::deque<Plan> plans_;  // by their start; before the first one all are at 0
};

}  // namespace flexura
