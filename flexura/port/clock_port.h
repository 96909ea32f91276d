#pragma once

namespace flexura {

/// The rig's time: the only clock that algorithms see.
class ClockPort {
 public:
  virtual ~ClockPort() = default;
  ClockPort() = default;
  ClockPort(const ClockPort&) = delete;
  ClockPort& operator=(const ClockPort&) = delete;

  /// s since the rig was started; never falls.
  [[nodiscard]] virtual double now() const = 0;
  /// Returns at `time`, or at once when it has passed. std::invalid_argument for a time that is not finite.
  virtual void wait_until(double time) = 0;
};

}  // namespace flexura
