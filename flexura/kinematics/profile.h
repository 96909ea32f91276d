#pragma once

namespace flexura {

/// Time profile of a motion between two points: the completed fraction of the distance, from 0 at time 0 to 1
/// at `duration`. Every profile is symmetric in time. The rate of a profile never decreases before the middle
/// of the duration, and never increases after it.
class Profile {
 public:
  /// Returns a profile with a constant rate. This function and the following functions throw
  /// std::invalid_argument unless the duration, s, is above 0.
  [[nodiscard]] static Profile linear(double duration);
  /// Returns the minimum-jerk profile 10 x^3 - 15 x^4 + 6 x^5, with x = t / duration. This profile has zero
  /// rate and acceleration at both ends, and the least integral of squared jerk.
  [[nodiscard]] static Profile minimum_jerk(double duration);
  /// Returns the fastest profile over `distance` > 0 with |rate| <= max_rate and |acceleration| <=
  /// max_acceleration. Both limits are above 0, in units of distance per s and per s^2. The profile has a
  /// phase of constant acceleration, a phase of constant rate if max_rate is reached, and a phase of constant
  /// deceleration.
  [[nodiscard]] static Profile trapezoid(double distance, double max_rate, double max_acceleration);

  [[nodiscard]] double duration() const { return duration_; }  ///< Duration, s.
  /// Returns the completed fraction at `time`, s: exactly 0 until time 0, and exactly 1 after `duration`.
  [[nodiscard]] double fraction(double time) const;
  /// Returns d fraction / dt at `time`, 1/s; 0 outside [0, duration].
  [[nodiscard]] double rate(double time) const;
  /// Returns the exact largest rate in [start, end], s, in 1/s.
  [[nodiscard]] double max_rate(double start, double end) const;
  /// Returns the exact smallest rate in [start, end], s, in 1/s.
  [[nodiscard]] double min_rate(double start, double end) const;

 private:
  enum class Kind { linear, minimum_jerk, trapezoid };
  Profile(Kind kind, double duration, double ramp);

  Kind kind_;
  double duration_;
  double ramp_;  // Time of acceleration, s; trapezoid only.
};

}  // namespace flexura
