#include "flexura/equipment/wall_clock.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

namespace flexura {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

WallClock::WallClock(std::function<void()> while_waiting, double interval)
    : start_(steady_seconds()), while_waiting_(std::move(while_waiting)), interval_(interval) {
  if (!std::isfinite(interval) || interval <= 0)
    throw std::invalid_argument("the interval of a clock must be finite and above 0");
}

double WallClock::now() const { return steady_seconds() - start_; }

void WallClock::wait_until(double time) {
  if (!std::isfinite(time)) throw std::invalid_argument("the time to wait for must be finite");
  for (double left = time - now(); left > 0; left = time - now()) {
    if (while_waiting_) while_waiting_();
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, interval_)));
  }
}

}  // namespace flexura
