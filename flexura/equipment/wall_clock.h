#pragma once

#include <functional>

#include "flexura/port/clock_port.h"

namespace flexura {

/// Real time, s, since the clock was made. Changes of the date do not affect it.
class WallClock : public ClockPort {
 public:
  /// While wait_until() waits, it calls `while_waiting` every `interval` s or more often, > 0.
  explicit WallClock(std::function<void()> while_waiting = {}, double interval = 0.02);

  [[nodiscard]] double now() const override;
  /// Returns the steady_seconds() at which this clock shows 0.
  [[nodiscard]] double start() const { return start_; }
  void wait_until(double time) override;

 private:
  double start_;
  std::function<void()> while_waiting_;
  double interval_;
};

/// Returns the time since an arbitrary instant, s, the same for all threads.
[[nodiscard]] double steady_seconds();

}  // namespace flexura
