#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "flexura/port/clock_port.h"

namespace flexura {

/// Time, from 0 s on, that passes when somebody waits, and takes none.
class SimulatedClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return now_; }
  void wait_until(double time) override {
    if (!std::isfinite(time))
      throw std::invalid_argument("a clock cannot wait for a time that is not finite");
    now_ = std::max(now_, time);
  }

 private:
  double now_ = 0;
};

}  // namespace flexura
