#pragma once

#include <deque>
#include <vector>

#include "flexura/model/arm.h"

namespace flexura {

/// An arm whose sections bend by themselves, without drives: each goes straight to its target in the
/// time given, or, where that is too short, at its largest bend rate; its stretch along with it. A function
/// of time and of the commands up to then, as AxisMotion is.
class BendMotion {
 public:
  /// At rest in `start`; asked for times back to `horizon` s before the last command.
  BendMotion(const Arm& arm, const ArmState& start, double horizon);

  /// From `time` on, for `duration` s or as long as it must, to the shape nearest to `target` within the
  /// sections' limits. std::invalid_argument: before the last command, or a target that does not fit the arm.
  void command(double time, const ArmState& target, double duration);
  void halt(double time);

  [[nodiscard]] ArmState at(double time) const;
  [[nodiscard]] bool is_moving(double time) const;
  /// When the last commanded motion ends, s; minus infinity: none was.
  [[nodiscard]] double end() const;

 private:
  struct Plan {
    double start = 0;
    ArmState from, to;
    std::vector<double> durations;  // s, one a section
  };
  [[nodiscard]] static ArmState at(const Plan& plan, double time);
  void go(double time, ArmState target, double duration);

  std::vector<Section> sections_;
  double horizon_;
  std::deque<Plan> plans_;  // by their start; never empty
};

}  // namespace flexura
