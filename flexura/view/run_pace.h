#pragma once

#include <optional>

namespace flexura {

/// Limits the speed of a run of tasks, so that people can follow it. The run's time advances `speed` times as
/// fast as a clock. If the run is delayed, it does not catch up later. Pauses of the clock do not count.
class RunPace {
 public:
  /// `speed`: run seconds per second of the clock; 0: as fast as possible. `step`: step of the run's clock,
  /// s.
  RunPace(double speed, double step) : speed_(speed), step_(step) {}

  [[nodiscard]] double speed() const { return speed_; }
  /// Changes the speed from now on.
  void set_speed(double speed);
  /// Returns the time up to which the run may advance, s. `passed`: time of the clock since the last call, s.
  /// `reached`: present time of the run, s. The result is infinite for speed 0.
  [[nodiscard]] double next(double passed, double reached);
  /// Returns the recent speed of the run, in run seconds per second of the clock, if the run is slower than
  /// `speed`. Otherwise returns std::nullopt.
  [[nodiscard]] std::optional<double> slowness() const;

 private:
  double speed_, step_;
  double allowed_ = 0;  // Time up to which the run may advance, s.
  double reached_ = 0;  // Time of the run at the last call, s.
  double rate_ = 0;     // Recent speed, run seconds per second of the clock.
  double behind_ = 0;   // Time for which the run has been too slow, s of the clock.
};

}  // namespace flexura
