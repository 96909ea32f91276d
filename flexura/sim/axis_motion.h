#pragma once

#include <array>
#include <deque>

#include "flexura/camera/axis_config.h"

namespace flexura {

/// Motion of one motor-driven axis and its load over time, in the unit of the axis's position. From any
/// current motion, the axis moves to each target as fast as its rate and acceleration allow, and stops there.
///
/// The motion is a function of time and of the commands up to this time. Queries change nothing, so results
/// are bit-identical for any number and order of queries.
class AxisMotion {
 public:
  /// Backlash: the load's position is within motor + [low, high]. The load stays at rest while the motor
  /// moves through this range.
  struct Backlash {
    double low = 0,
           high = 0;  ///< Bounds of the difference of load and motor position, with low <= 0 <= high.
  };

  /// Creates an axis whose motor and load rest at `start`. A command takes effect `delay` s after it was
  /// given. Queries are allowed back to `horizon` s before the last command.
  AxisMotion(const AxisConfig& axis, const Backlash& backlash, double start, double delay, double horizon);

  /// Commands a motion that begins at `time` + delay and ends at the commandable position nearest to
  /// `target`. The motion takes `duration` s, or longer if limits require it. Throws std::invalid_argument if
  /// `time` is before the last command.
  void command(double time, double target, double duration = 0);
  /// Commands a stop that begins at `time` + delay, as fast as the acceleration allows.
  void halt(double time);

  /// Returns the position of the motor.
  [[nodiscard]] double motor(double time) const { return plan_at(time).at(time).position; }
  /// Returns the rate of the motor.
  [[nodiscard]] double rate(double time) const { return plan_at(time).at(time).rate; }
  /// Returns the position of the load, which includes the backlash.
  [[nodiscard]] double position(double time) const { return carried(plan_at(time), time); }
  /// Returns whether a commanded motion has not ended yet.
  [[nodiscard]] bool is_moving(double time) const { return plans_.back().end > time; }

 private:
  struct State {
    double position, rate;
  };
  struct Piece {  // Motion with constant acceleration.
    double start, position, rate, acceleration;
  };
  struct Plan {
    double start = 0, end = 0, target = 0;
    double carried = 0;             // Position of the load at the start.
    double turn = 0;                // Time at which the motor reverses; the start if it does not.
    int count = 0;                  // Number of pieces.
    std::array<Piece, 3> pieces{};  // From the start to the end.
    [[nodiscard]] State at(double time) const;
    void add(double duration, double rate, double acceleration);
  };

  [[nodiscard]] const Plan& plan_at(double time) const;
  [[nodiscard]] double carried(const Plan& plan, double time) const;
  void go(double time, double target, double duration);
  void fill(Plan& plan, const State& from, double target, double duration) const;
  [[nodiscard]] double peak_rate(double way, double rate, double duration) const;

  AxisConfig axis_;
  Backlash backlash_;
  double delay_, horizon_;
  std::deque<Plan> plans_;  // Ordered by start; never empty.
};

}  // namespace flexura
