#pragma once

#include <vector>

namespace flexura {

/// Motion of an axis with trapezoidal speed, as a function of time. The caller chooses the unit of positions.
class Cia402Ramp {
 public:
  /// Makes an axis at rest at a position.
  explicit Cia402Ramp(double position = 0) : target_(position) {}

  /// Sets position and velocity at `now`, s; the axis then keeps its velocity.
  void set(double now, double position, double velocity = 0);
  /// Starts to move to `target` at time `now`, s, at a speed of at most `speed` > 0, with the given
  /// acceleration and deceleration > 0. If the axis cannot stop before the target, it overshoots and returns.
  void move(double now, double target, double speed, double acceleration, double deceleration);
  /// Brakes from `now` on.
  void stop(double now, double deceleration);

  /// Returns the position at time `now`, s, which must not be before the last command.
  [[nodiscard]] double position(double now) const;
  [[nodiscard]] double velocity(double now) const;
  /// Returns the time at which the axis comes to rest, s.
  [[nodiscard]] double end() const { return end_; }
  [[nodiscard]] bool is_moving(double now) const { return now < end_; }

 private:
  struct Phase {
    double start, position, velocity, acceleration;
  };
  [[nodiscard]] const Phase* phase_at(double now) const;
  void add(double duration, double acceleration);

  std::vector<Phase> phases_;
  double target_;
  double end_ = -1e300;
  double next_position_ = 0, next_velocity_ = 0;
};

/// Returns the cruising speed, > 0, with which an axis moves by `distance` in `duration` s and stops there.
/// The axis starts with `velocity`, positive towards the target, and accelerates and brakes with
/// `acceleration`. The result is at most `most`, and equals `most` if the duration is too short.
[[nodiscard]] double cia402_speed(double distance, double velocity, double duration, double acceleration,
                                  double most);

}  // namespace flexura
