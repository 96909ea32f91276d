#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/grbl_drive.h"
#include "flexura/equipment/link_faults.h"

// A drive and a simulated controller on a link in simulated time, without threads.
namespace flexura {

/// Time that passes only when a link waits.
class SteppedClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return time_; }
  void wait_until(double time) override { time_ = std::max(time_, time); }

 private:
  double time_ = 100;
};

/// Connects the two sides. Each call takes a little time.
class SteppedLink : public Link {
 public:
  SteppedLink(ServedDevice& device, SteppedClock& clock, std::uint64_t seed = 1)
      : device_(device), clock_(clock), in_(2 * seed), out_(2 * seed + 1) {}

  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    in_.put(std::string(bytes), faults, clock_.now());
    if (!is_silent) written += bytes;
    pass(call_time);
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    const double end = clock_.now() + timeout;
    do {
      pass(std::clamp(end - clock_.now(), call_time, 1e-3));
    } while (heard_.empty() && clock_.now() < end);
    return std::exchange(heard_, {});
  }
  /// Lets time pass.
  void pass(double duration) {
    const double end = clock_.now() + duration;
    while (clock_.now() < end) {
      clock_.wait_until(std::min(end, clock_.now() + 1e-3));
      const double now = clock_.now();
      for (const std::string& message : in_.take(now))
        if (!is_silent) say(device_.receive(message, now));
      say(device_.advance(now));
      if (on_tick) on_tick(now);
      for (const std::string& message : out_.take(now))
        if (!is_silent) heard_ += message;
    }
  }

  LinkFaults faults;
  bool is_silent = false;
  std::string written;                  ///< All that was sent.
  std::function<void(double)> on_tick;  ///< Called with the time, every ms or more often.

 private:
  static constexpr double call_time = 2e-4;  // s
  void say(std::vector<std::string> messages) {
    for (std::string& message : messages) out_.put(std::move(message), faults, clock_.now());
  }
  ServedDevice& device_;
  SteppedClock& clock_;
  FaultyCarrier in_, out_;
  std::string name_ = "board", heard_;
};

/// A drive with a controller.
struct GrblBench {
  explicit GrblBench(GrblDeviceConfig on_board = {}, GrblConfig config = {}, std::uint64_t seed = 1)
      : device(std::move(on_board)) {
    auto made = std::make_unique<SteppedLink>(device, clock, seed);
    link = made.get();
    drive = std::make_unique<GrblDrive>(std::move(made), clock, std::move(config));
  }
  /// Connects, with all motors at position 0.
  CommandOutcome start() {
    auto connected = drive->connect();
    if (!connected) return connected;
    return drive->set_positions(std::vector<double>(drive->axes(), 0));
  }
  /// Returns the motors' positions now.
  std::vector<double> motors() { return device.positions(clock.now()); }

  SteppedClock clock;
  GrblDevice device;
  SteppedLink* link = nullptr;
  std::unique_ptr<GrblDrive> drive;
};

}  // namespace flexura
