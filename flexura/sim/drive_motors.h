#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/drive.h"
#include "flexura/sim/axis_motion.h"

namespace flexura {

/// The motors of a drive over time, with the play behind each. Positions are microsteps, each in its motor's
/// own sense. A function of time and of the commands up to then, as AxisMotion is.
class DriveMotors {
 public:
  /// At rest at `start`, with the play taken up for pulling in. Play and senses are those of `drive`; limits,
  /// rates and accelerations are those of the motors of `real`. Known back to `horizon` s before the last
  /// command. All three have as many axes.
  DriveMotors(const Drive& drive, const Drive& real, const std::vector<std::int64_t>& start, double horizon);

  /// From `time` on to `positions`, one an axis, within `duration` s or as long as each motor must.
  void command(double time, std::span<const double> positions, double duration);
  /// The motors brake as fast as they can.
  void halt(double time);

  [[nodiscard]] std::size_t axes() const { return motions_.size(); }
  /// Where the motors are at `time` s.
  [[nodiscard]] std::vector<double> positions(double time) const;
  /// How fast they turn then, microsteps/s.
  [[nodiscard]] std::vector<double> rates(double time) const;
  /// And what is behind their play.
  [[nodiscard]] std::vector<double> carried(double time) const;
  /// Whether a commanded motion of any is under way or still to come.
  [[nodiscard]] bool is_moving(double time) const;

 private:
  std::vector<double> senses_;       // 1, or -1 of a motor whose positive microsteps let cable out
  std::vector<AxisMotion> motions_;  // in microsteps pulled in
};

}  // namespace flexura
