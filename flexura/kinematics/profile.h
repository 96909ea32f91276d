#pragma once

namespace flexura {

/// How a motion between two points goes in time: the fraction of the way done, from 0 at time 0 to 1 at
/// `duration`. Every profile is symmetric, and its rate rises to the middle and falls from there.
class Profile {
 public:
  /// Constant rate. duration > 0 s, else std::invalid_argument (all profiles).
  [[nodiscard]] static Profile linear(double duration);
  /// The polynomial of least squared jerk that starts and ends at rest without acceleration:
  /// 10 x^3 - 15 x^4 + 6 x^5, x = t / duration.
  [[nodiscard]] static Profile minimum_jerk(double duration);
  /// The fastest way over `distance` > 0 within |rate| <= max_rate and |acceleration| <= max_acceleration
  /// (both > 0, in units of the distance per s and s^2): even acceleration, even rate where that is reached,
  /// even deceleration.
  [[nodiscard]] static Profile trapezoid(double distance, double max_rate, double max_acceleration);

  [[nodiscard]] double duration() const { return duration_; }  ///< s
  /// In [0, 1]; exactly 0 up to time 0 and 1 from the duration on.
  [[nodiscard]] double fraction(double time) const;
  /// d fraction / dt, 1/s; 0 outside [0, duration].
  [[nodiscard]] double rate(double time) const;
  /// The largest rate in [start, end], 1/s. Exact.
  [[nodiscard]] double max_rate(double start, double end) const;
  /// The least rate in [start, end], 1/s. Exact.
  [[nodiscard]] double min_rate(double start, double end) const;

 private:
  enum class Kind { linear, minimum_jerk, trapezoid };
  Profile(Kind kind, double duration, double ramp);

  Kind kind_;
  double duration_;
  double ramp_;  // s of acceleration; trapezoid only
};

}  // namespace flexura
