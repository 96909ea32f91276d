#pragma once

namespace flexura {

/// Clock of the rig, the only clock that algorithms use.
class ClockPort {
 public:
  virtual ~ClockPort() = default;
  ClockPort() = default;
  ClockPort(const ClockPort&) = delete;
  ClockPort& operator=(const ClockPort&) = delete;

  /// Returns the time since the start of the rig, s. Never decreases.
  [[nodiscard]] virtual double now() const = 0;
  /// Returns when the clock reaches `time`, s, or at once if `time` has passed. Throws std::invalid_argument
  /// if `time` is not finite.
  virtual void wait_until(double time) = 0;
};

}  // namespace flexura
