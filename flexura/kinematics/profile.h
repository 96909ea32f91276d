#pragma once

namespace flexura {

/// Time profile of a motion between two points: the fraction of the way, from 0 at time 0 to 1 at `duration`.
/// Every profile is symmetric, and its rate rises to the middle and falls from there.
class Profile {
 public:
  /// Returns a profile of constant rate. All profiles throw std::invalid_argument unless duration > 0 s.
  [[nodiscard]] static Profile linear(double duration);
  /// Returns the polynomial of least squared jerk that starts and ends at rest without acceleration: 10 x^3 -
  /// 15 x^4 + 6 x^5, x = t / duration.
  [[nodiscard]] static Profile minimum_jerk(double duration);
  /// Returns the fastest profile over `distance` > 0 with |rate| <= max_rate and |acceleration| <=
  /// max_acceleration. Both are > 0, in units of the distance per s and s^2. It has constant acceleration,
  /// constant rate where that is reached, constant deceleration.
  [[nodiscard]] static Profile trapezoid(double distance, double max_rate, double max_acceleration);

  [[nodiscard]] double duration() const { return duration_; }  ///< In s.
  /// Returns the fraction in [0, 1]; exactly 0 up to time 0 and 1 from the duration on.
  [[nodiscard]] double fraction(double time) const;
  /// Returns d fraction / dt, 1/s; 0 outside [0, duration].
  [[nodiscard]] double rate(double time) const;
  /// Returns the largest rate in [start, end], 1/s. Exact.
  [[nodiscard]] double max_rate(double start, double end) const;
  /// Returns the least rate in [start, end], 1/s. Exact.
  [[nodiscard]] double min_rate(double start, double end) const;

 private:
  enum class Kind { linear, minimum_jerk, trapezoid };
  Profile(Kind kind, double duration, double ramp);

  Kind kind_;
  double duration_;
  double ramp_;  // Time of acceleration, s; trapezoid only.
};

}  // namespace flexura
