#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/equipment/device_server.h"
#include "flexura/equipment/guard_process.h"
#include "flexura/equipment/link.h"
#include "flexura/equipment/link_faults.h"
#include "tests/support/simulated_threads.h"

namespace flexura {

/// A link for several threads to a simulated device, both in simulated time.
class SimulatedLine : public Link {
 public:
  /// `is_stream`: bytes that have arrived are read together, as on a serial line.
  SimulatedLine(SimulatedThreads& time, ServedDevice& device, std::string name, bool is_stream,
                std::uint64_t seed)
      : time_(time),
        device_(device),
        name_(std::move(name)),
        is_stream_(is_stream),
        in_(2 * seed),
        out_(2 * seed + 1) {}

  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    SimulatedThreads::Lock lock = time_.enter();
    if (is_full) time_.wait(lock, time_.now() + write_timeout, [this] { return !is_full || is_gone; });
    if (is_gone) return PortFault{FaultKind::link_lost, name_ + ": Input/output error"};
    if (is_full) return PortFault{FaultKind::link_lost, name_ + ": the device does not take data"};
    send(bytes);
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    SimulatedThreads::Lock lock = time_.enter();
    time_.wait(lock, time_.now() + timeout, [this] { return !heard_.empty() || is_gone; });
    if (is_gone) return PortFault{FaultKind::link_lost, name_ + ": Input/output error"};
    std::string bytes;
    do {
      if (heard_.empty()) break;
      bytes += heard_.front();
      heard_.pop_front();
    } while (is_stream_);
    return bytes;
  }

  // What follows needs the lock of the time.

  /// Sends bytes without waiting.
  void send(std::string_view bytes) {
    if (!is_silent && !is_gone) in_.put(std::string(bytes), faults, time_.now());
  }
  /// Carries messages, and lets the device do what is due.
  void step(double now) {
    for (const std::string& message : in_.take(now)) say(device_.receive(message, now), now);
    say(device_.advance(now), now);
    for (std::string& message : out_.take(now))
      if (!is_silent && !is_gone) heard_.push_back(std::move(message));
  }

  LinkFaults faults;
  bool is_silent = false;  ///< Whether the cable is pulled out at the device.
  bool is_gone = false;    ///< Whether the computer has lost the link.
  bool is_full = false;    ///< Whether the device's buffer takes nothing.

 private:
  static constexpr double write_timeout = 1;  // s
  void say(std::vector<std::string> messages, double now) {
    for (std::string& message : messages)
      if (!is_silent && !is_gone) out_.put(std::move(message), faults, now);
  }
  SimulatedThreads& time_;
  ServedDevice& device_;
  std::string name_;
  bool is_stream_;
  FaultyCarrier in_, out_;
  std::deque<std::string> heard_;
};

/// The guard of a program with simulated lines. Decides as the second process does.
class SimulatedWatchdog : public Watchdog {
 public:
  SimulatedWatchdog(SimulatedThreads& time, double period) : time_(time), period_(period), watch_(*this) {}

  [[nodiscard]] double period() const override { return period_; }
  bool beat(bool is_moving) override {
    const SimulatedThreads::Lock lock = time_.enter();
    GuardMessage message;
    message.kind = is_moving ? GuardMessage::Kind::moving : GuardMessage::Kind::resting;
    watch_.heed(message, -1, time_.now());
    last_beat_ = time_.now();
    return !std::exchange(has_stopped_, false);
  }
  /// Protects the device at a line.
  void protect(SimulatedLine& line, const StopMessages& stop) {
    lines_.push_back(&line);
    watch_.heed(guard_message(stop, "line"), static_cast<int>(lines_.size()) - 1, time_.now());
  }
  /// Sends what is due. Needs the lock of the time.
  void step(double now) {
    if (!watch_.advance(now)) return;
    has_stopped_ = true;
    ++stops_;
    stopped_at_ = now;
  }
  [[nodiscard]] int stops() const { return stops_; }
  [[nodiscard]] double stopped_at() const { return stopped_at_; }
  [[nodiscard]] double last_beat() const { return last_beat_; }

 private:
  class Watch : public GuardWatch {
   public:
    explicit Watch(SimulatedWatchdog& of) : GuardWatch(of.period_), of_(of) {}

   private:
    void send(int link, const char* bytes, std::size_t size) noexcept override {
      of_.lines_[static_cast<std::size_t>(link)]->send({bytes, size});
    }
    void send_to_address(std::size_t /*device*/, const GuardMessage& /*stop*/) noexcept override {}
    SimulatedWatchdog& of_;
  };
  SimulatedThreads& time_;
  double period_;
  std::vector<SimulatedLine*> lines_;
  Watch watch_;
  bool has_stopped_ = false;
  int stops_ = 0;
  double stopped_at_ = 0, last_beat_ = 0;
};

}  // namespace flexura
