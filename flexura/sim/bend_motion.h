#pragma once

#include <deque>
#include <vector>

#include "flexura/model/arm.h"

namespace flexura {

/// Motion of an arm without drives, whose sections bend as commanded. Each section moves at constant rates to
/// its target in the given time, or at its largest bend rate if the given time is too short. The section's
/// stretch takes the same time as its bend. Like AxisMotion, the motion is a function of time and of the
/// commands up to this time.
class BendMotion {
 public:
  /// Starts at rest in the state `start`. Queries are allowed back to `horizon` s before the last command.
  BendMotion(const Arm& arm, const ArmState& start, double horizon);

  /// Commands a motion that begins at `time` and ends at the shape nearest to `target` within the sections'
  /// limits. The motion takes `duration` s, or longer if needed. Throws std::invalid_argument if `time` is
  /// before the last command, or if `target` does not fit the arm.
  void command(double time, const ArmState& target, double duration);
  void halt(double time);

  [[nodiscard]] ArmState at(double time) const;
  [[nodiscard]] bool is_moving(double time) const;
  /// Returns the end of the last commanded motion, s; minus infinity without a command.
  [[nodiscard]] double end() const;

 private:
  struct Plan {
    double start = 0;
    ArmState from, to;
    std::vector<double> durations;  // Duration for each section, s.
  };
  [[nodiscard]] static ArmState at(const Plan& plan, double time);
  void go(double time, ArmState target, double duration);

  std::vector<Section> sections_;
  double horizon_;
  std::deque<Plan> plans_;  // Ordered by start; never empty.
};

}  // namespace flexura
