#pragma once

#include <optional>

namespace flexura {

/// How far a run of tasks may go, so that people can follow it: its time goes with a clock, `speed` times as
/// fast. Time that the run
/// could not keep up with is not caught up later. Pauses of the clock do not count.
class RunPace {
 public:
  /// `speed` in run seconds per second of the clock; 0: as fast as it can. `step`: of the run's clock, s.
  RunPace(double speed, double step) : speed_(speed), step_(step) {}

  [[nodiscard]] double speed() const { return speed_; }
  /// From now on at another speed.
  void set_speed(double speed);
  /// Returns the run's time, s, up to which it may go, `passed` s of the clock after the last call;
  /// `reached` is its time now, s. Infinite for speed 0.
  [[nodiscard]] double next(double passed, double reached);
  /// Returns how fast the run goes of late, in run seconds per second of the clock, if it does not keep up
  /// with the speed; else std::nullopt.
  [[nodiscard]] std::optional<double> slowness() const;

 private:
  double speed_, step_;
  double allowed_ = 0;  // s of the run
  double reached_ = 0;  // Time of the run at the last call, s.
  double rate_ = 0;     // Run seconds per second, of late.
  double behind_ = 0;   // For how long it has been behind, s of the clock.
};

}  // namespace flexura
