#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"
#include "flexura/sim/axis_motion.h"

namespace flexura {

/// Motion of a drive's motors over time, and of the loads behind their backlash. Positions are in microsteps,
/// in each motor's own sense. Like AxisMotion, it is a function of time and of the commands up to that time.
class DriveMotors {
 public:
  /// Starts at rest at `start`, microsteps, with the backlash taken up for pulling in. Backlash and senses
  /// are those of `drive`. Limits, rates and accelerations are those of the motors of `real`. Queries are
  /// allowed back to `horizon` s before the last command. `drive`, `real` and `start` have the same number of
  /// axes.
  DriveMotors(const Drive& drive, const Drive& real, const std::vector<std::int64_t>& start, double horizon);

  /// From `time` on, moves to `positions`, one per axis, within `duration` s. A motor that needs longer takes
  /// longer.
  void command(double time, std::span<const double> positions, double duration);
  /// Stops the motors as fast as they can.
  void halt(double time);

  [[nodiscard]] std::size_t axes() const { return motions_.size(); }
  /// Returns the motor positions at `time` s, microsteps.
  [[nodiscard]] std::vector<double> positions(double time) const;
  /// Returns the motor rates at `time` s, microsteps/s.
  [[nodiscard]] std::vector<double> rates(double time) const;
  /// Returns the positions behind the backlash at `time` s, microsteps.
  [[nodiscard]] std::vector<double> carried(double time) const;
  /// Returns whether a commanded motion of any motor has not ended yet.
  [[nodiscard]] bool is_moving(double time) const;

 private:
  std::vector<double> senses_;       // 1, or -1 for a motor whose positive microsteps let cable out.
  std::vector<AxisMotion> motions_;  // In microsteps pulled in.
};

}  // namespace flexura
