#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/equipment/device_server.h"
#include "flexura/equipment/link.h"
#include "flexura/equipment/link_faults.h"

namespace flexura {

/// A link to a simulated device in the same thread, with a time of its own that passes while the driver
/// waits.
class ViscaWire : public Link {
 public:
  explicit ViscaWire(ServedDevice& device, std::uint64_t seed = 1)
      : device_(device), in_(2 * seed), out_(2 * seed + 1) {}

  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    written.emplace_back(bytes);
    if (is_broken) return PortFault{FaultKind::link_lost, "Input/output error"};
    if (!is_silent) in_.put(std::string(bytes), faults, time);
    step();
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    if (is_broken) return PortFault{FaultKind::link_lost, "Input/output error"};
    const double end = time + timeout;
    step();
    while (inbox_.empty() && time < end) {
      time = std::min(time + tick, end);
      step();
    }
    if (inbox_.empty()) return std::string();
    std::string bytes = std::move(inbox_.front());
    inbox_.pop_front();
    return bytes;
  }
  /// Lets time pass, s.
  void pass(double duration) {
    for (const double end = time + duration; time < end;) {
      time = std::min(time + tick, end);
      step();
    }
  }

  double time = 100;  ///< s
  LinkFaults faults;
  bool is_silent = false, is_broken = false;
  std::vector<std::string> written;          ///< All messages of the driver.
  std::function<void(double time)> on_step;  ///< Called after each step.

 private:
  static constexpr double tick = 0.002;  // s
  void step() {
    const auto send = [&](std::vector<std::string> answers) {
      for (std::string& answer : answers)
        if (!is_silent) out_.put(std::move(answer), faults, time);
    };
    for (const std::string& message : in_.take(time)) send(device_.receive(message, time));
    send(device_.advance(time));
    for (std::string& message : out_.take(time)) inbox_.push_back(std::move(message));
    if (on_step) on_step(time);
  }

  ServedDevice& device_;
  FaultyCarrier in_, out_;
  std::deque<std::string> inbox_;
  std::string name_ = "/dev/head";
};

}  // namespace flexura
