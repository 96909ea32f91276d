#pragma once

#include <functional>

#include "flexura/port/clock_port.h"

namespace flexura {

/// Real time since the construction of the clock, s. Changes of the system's date do not affect this clock.
class WallClock : public ClockPort {
 public:
  /// While wait_until() waits, it calls `while_waiting` at least every `interval` s, > 0.
  explicit WallClock(std::function<void()> while_waiting = {}, double interval = 0.02);

  [[nodiscard]] double now() const override;
  /// Returns the time on the clock steady_seconds() at which this clock shows 0, s.
  [[nodiscard]] double start() const { return start_; }
  void wait_until(double time) override;

 private:
  double start_;
  std::function<void()> while_waiting_;
  double interval_;
};

/// Returns the time since an arbitrary instant, s. The instant is the same for all threads.
[[nodiscard]] double steady_seconds();

}  // namespace flexura
