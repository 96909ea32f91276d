#pragma once

#include <array>
#include <deque>

#include "flexura/camera/axis_config.h"

namespace flexura {

/// One motor-driven axis over time: what it carries, in the units of its position. It goes to each target as
/// fast as its rate and acceleration allow, from whatever motion it is in, and stands there.
///
/// It is a function of time and of the commands up to then: asking changes nothing, so that it is the same to
/// the bit however often and when it is asked.
class AxisMotion {
 public:
  /// What is carried lies within motor + [low, high]: it stays while the motor moves through the play.
  struct Backlash {
    double low = 0, high = 0;  ///< low <= 0 <= high
  };

  /// At rest at `start` (motor and what it carries). A command takes effect `delay` s after it was given. The
  /// axis can be asked for times back to `horizon` s before the last command.
  AxisMotion(const AxisConfig& axis, const Backlash& backlash, double start, double delay, double horizon);

  /// To the nearest position that can be commanded, from `time` + delay on; never before the last command,
  /// else std::invalid_argument. It takes `duration` s, or as long as it must.
  void command(double time, double target, double duration = 0);
  /// Stops at `time` + delay, as fast as the acceleration allows.
  void halt(double time);

  /// Where the motor is.
  [[nodiscard]] double motor(double time) const { return plan_at(time).at(time).position; }
  /// How fast it moves.
  [[nodiscard]] double rate(double time) const { return plan_at(time).at(time).rate; }
  /// Where what it carries is.
  [[nodiscard]] double position(double time) const { return carried(plan_at(time), time); }
  /// Whether a commanded motion is under way or still to come.
  [[nodiscard]] bool is_moving(double time) const { return plans_.back().end > time; }

 private:
  struct State {
    double position, rate;
  };
  struct Piece {  // of even acceleration
    double start, position, rate, acceleration;
  };
  struct Plan {
    double start = 0, end = 0, target = 0;
    double carried = 0;             // at the start
    double turn = 0;                // when the motor reverses on the way; the start when it does not
    int count = 0;                  // of pieces
    std::array<Piece, 3> pieces{};  // from the start to the end
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
  std::deque<Plan> plans_;  // by their start; never empty
};

}  // namespace flexura
