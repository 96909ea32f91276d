#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "flexura/port/clock_port.h"

namespace flexura {

/// A clock of simulated time that starts at 0 s. Waiting advances the clock without taking real time.
class SimulatedClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return now_; }
  void wait_until(double time) override {
    if (!std::isfinite(time))
      throw std::invalid_argument("a clock cannot wait for a time that is not finite");
    if (!(time > now_)) return;
    now_ = time;
    if (passed_) passed_(now_);
  }
  /// Registers a function that is called with the new time after each advance of the clock. The function
  /// advances the simulated world.
  void when_passed(std::function<void(double)> passed) { passed_ = std::move(passed); }

 private:
  double now_ = 0;
  std::function<void(double)> passed_;
};

}  // namespace flexura
