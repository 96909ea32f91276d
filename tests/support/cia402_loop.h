#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/equipment/cia402_device.h"
#include "flexura/equipment/cia402_drive.h"
#include "flexura/equipment/link_faults.h"

namespace flexura {

/// A clock that only its users move on.
class HandClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return time; }
  void wait_until(double until) override { time = std::max<double>(until, time); }
  std::atomic<double> time = 0;
};

/// A bus with simulated drives in simulated time: a frame takes 0.2 ms, and waiting takes no real time.
class LoopBus : public Link {
 public:
  LoopBus(Cia402Device& device, HandClock& clock, std::uint64_t seed = 1)
      : device_(device), clock_(clock), in_(2 * seed), out_(2 * seed + 1) {}

  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    const auto frame = parse_can_frame(bytes);
    const bool arrives = passes(frame ? *frame : CanFrame{});
    const std::scoped_lock lock(mutex_);
    clock_.time += 0.0002;
    ++written;
    if (!is_silent && arrives) in_.put(std::string(bytes), faults, clock_.time);
    exchange();
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    const double end = clock_.time + timeout;
    for (;;) {
      const std::scoped_lock lock(mutex_);
      exchange();
      if (!queue_.empty()) {
        std::string first = std::move(queue_.front());
        queue_.pop_front();
        return first;
      }
      if (clock_.time >= end) return std::string();
      clock_.time += 0.0002;
    }
  }
  /// Lets time pass.
  void pass(double duration) {
    const std::scoped_lock lock(mutex_);
    for (const double end = clock_.time + duration; clock_.time < end; clock_.time += 0.001) exchange();
  }

  LinkFaults faults;
  bool is_silent = false;  ///< Whether the cable is pulled out.
  std::size_t written = 0;
  /// Called with each frame of the driver; returns whether it arrives.
  std::function<bool(const CanFrame&)> passes = [](const CanFrame&) { return true; };
  std::function<void()> observer = [] {};  ///< Called often while time passes.

 private:
  void exchange() {
    const double now = clock_.time;
    std::vector<std::string> answers = device_.advance(now);
    for (const std::string& message : in_.take(now))
      for (std::string& answer : device_.receive(message, now)) answers.push_back(std::move(answer));
    observer();
    for (std::string& answer : answers)
      if (!is_silent) out_.put(std::move(answer), faults, now);
    for (std::string& answer : out_.take(now)) queue_.push_back(std::move(answer));
  }

  Cia402Device& device_;
  HandClock& clock_;
  FaultyCarrier in_, out_;
  std::mutex mutex_;
  std::deque<std::string> queue_;
  std::string name_ = "can:loop";
};

/// Some drives, their bus, and the driver.
struct Cia402Bench {
  explicit Cia402Bench(std::size_t axes = 4, std::uint64_t seed = 1, Cia402Config base = {})
      : config(made(axes, std::move(base))),
        device(nodes(axes)),
        bus(device, clock, seed),
        drive(bus, clock, config) {}

  static Cia402Config made(std::size_t axes, Cia402Config config) {
    for (std::size_t i = config.axes.size(); i < axes; ++i) {
      Cia402AxisConfig axis;
      axis.node = static_cast<std::int64_t>(i) + 1;
      axis.limits = {-5000, 5000};
      config.axes.push_back(axis);
    }
    return config;
  }
  static std::vector<Cia402NodeConfig> nodes(std::size_t axes) {
    std::vector<Cia402NodeConfig> nodes(axes);
    for (std::size_t i = 0; i < axes; ++i) {
      nodes[i].node = static_cast<std::uint8_t>(i + 1);
      nodes[i].home_switch = -300;
    }
    return nodes;
  }
  /// Returns the true positions, in the drives' units.
  [[nodiscard]] std::vector<double> positions() const { return device.positions(clock.time); }

  Cia402Config config;
  HandClock clock;
  Cia402Device device;
  LoopBus bus;
  Cia402Drive drive;
};

}  // namespace flexura
