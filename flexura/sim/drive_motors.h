#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"
#include "flexura/sim/axis_motion.h"

namespace flexura {

/// Motion of a drive's motors over time, and of the loads behind their backlash. Positions are in microsteps,
/// in each motor's own direction. Like AxisMotion, the motion is a function of time and of the commands up to
/// this time.
class DriveMotors {
 public:
  /// Starts at rest at `start`, microsteps. At the start, the motors have taken up the backlash for pulling
  /// in. The motors have the backlash and directions of `drive`. The motors have the limits, rates and
  /// accelerations of the motors of `real`. Queries are allowed back to `horizon` s before the last command.
  /// `drive`, `real` and `start` must have equal numbers of axes.
  DriveMotors(const Drive& drive, const Drive& real, const std::vector<std::int64_t>& start, double horizon);

  /// Commands a motion that begins at `time` and ends at `positions`, one per axis, after `duration` s.
  /// Motors with too low limits need more time.
  void command(double time, std::span<const double> positions, double duration);
  /// Stops the motors as fast as they can.
  void halt(double time);

  [[nodiscard]] std::size_t axes() const { return motions_.size(); }
  /// Returns the motor positions at `time`, s, in microsteps.
  [[nodiscard]] std::vector<double> positions(double time) const;
  /// Returns the motor rates at `time`, s, in microsteps/s.
  [[nodiscard]] std::vector<double> rates(double time) const;
  /// Returns the positions of the loads, which include the backlash, at `time`, s, in microsteps.
  [[nodiscard]] std::vector<double> carried(double time) const;
  /// Returns whether a commanded motion of any motor has not ended yet.
  [[nodiscard]] bool is_moving(double time) const;

 private:
  std::vector<double> senses_;       // 1, or -1 for a motor whose positive microsteps let cable out.
  std::vector<AxisMotion> motions_;  // In microsteps pulled in.
};

}  // namespace flexura
