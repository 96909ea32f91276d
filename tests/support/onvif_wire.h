#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/equipment/onvif_client.h"
#include "flexura/equipment/onvif_device.h"
#include "flexura/equipment/onvif_head.h"

namespace flexura {

/// A simulated camera in the same thread, with a time of its own that passes while the driver waits.
class OnvifWire {
 public:
  explicit OnvifWire(OnvifDevice& device) : device_(device) {}

  /// Returns ports to the camera. They must not outlive this object.
  [[nodiscard]] OnvifPorts ports() {
    return {[this]() -> Outcome<std::unique_ptr<Link>> {
              ++connections;
              if (is_unplugged) return PortFault{FaultKind::link_lost, "tcp:camera:80: No route to host"};
              return std::unique_ptr<Link>(std::make_unique<OnvifWireLink>(*this));
            },
            [this] { return time; }};
  }
  /// Lets time pass, s.
  void pass(double duration) { time += duration; }

  double time = 100;  ///< s
  bool is_unplugged = false;
  bool closes_idle = false;                  ///< Whether the camera closes connections after each answer.
  int connections = 0;                       ///< Opened ones.
  std::vector<std::string> written;          ///< All messages of the driver.
  std::function<void(double)> on_wait = {};  ///< Called while the driver waits.

 private:
  class OnvifWireLink : public Link {
   public:
    explicit OnvifWireLink(OnvifWire& wire) : wire_(wire), stream_(wire.device_) {}
    [[nodiscard]] const std::string& name() const override { return name_; }
    CommandOutcome write(std::string_view bytes) override {
      if (is_closed_) return PortFault{FaultKind::link_lost, "tcp:camera:80: Broken pipe"};
      wire_.written.emplace_back(bytes);
      for (OnvifChunk& chunk : stream_.receive(bytes, wire_.time)) waiting_.push_back(std::move(chunk));
      return Accepted{};
    }
    Outcome<std::string> read(double timeout) override {
      const double end = wire_.time + timeout;
      if (wire_.on_wait) wire_.on_wait(wire_.time);
      if (is_closed_)
        return PortFault{FaultKind::link_lost, "tcp:camera:80: the device closed the connection"};
      if (waiting_.empty() || waiting_.front().at > end) {
        wire_.time = end;
        return std::string();
      }
      wire_.time = std::max(wire_.time, waiting_.front().at);
      const OnvifChunk chunk = std::move(waiting_.front());
      waiting_.pop_front();
      is_closed_ = chunk.closes || (wire_.closes_idle && waiting_.empty());
      if (chunk.bytes.empty() && is_closed_)
        return PortFault{FaultKind::link_lost, "tcp:camera:80: the device closed the connection"};
      return chunk.bytes;
    }

   private:
    OnvifWire& wire_;
    OnvifStream stream_;
    std::deque<OnvifChunk> waiting_;
    std::string name_ = "tcp:camera:80";
    bool is_closed_ = false;
  };

  OnvifDevice& device_;
};

/// A head on a wire.
struct OnvifBench {
  static OnvifConfig usual() {
    OnvifConfig config;
    config.link = "tcp:camera:80";
    config.user = "operator", config.password_file = "unused";
    return config;
  }
  explicit OnvifBench(const OnvifConfig& with = usual(), const OnvifModel& model = {},
                      const std::string& password = "secret")
      : config(with), device(model), wire(device), head(wire.ports(), with, password) {}
  // Each returns the message of a fault.
  [[nodiscard]] std::string start() { return message(head.start()); }
  [[nodiscard]] std::string command(const HeadState& state) { return message(head.command(state)); }
  [[nodiscard]] std::string halt() { return message(head.halt()); }
  // Reads until the head stands, for at most `most` s.
  [[nodiscard]] std::string settle(double most = 60) {
    for (const double end = wire.time + most; wire.time < end; wire.pass(0.05)) {
      const auto read = head.read();
      if (!read) return read.fault()->what;
      if (!read.value().moving) return {};
    }
    return "still moves";
  }
  static std::string message(const CommandOutcome& outcome) {
    const auto fault = outcome.fault();
    return fault ? fault->what : std::string();
  }

  OnvifConfig config;
  OnvifDevice device;
  OnvifWire wire;
  OnvifHead head;
};

}  // namespace flexura
