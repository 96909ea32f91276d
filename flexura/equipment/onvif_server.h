#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

#include "flexura/base/descriptor.h"
#include "flexura/equipment/onvif_device.h"

namespace flexura {

/// Runs a simulated ONVIF camera on a TCP port of the loopback interface, in a separate thread and in real
/// time, until this object is destroyed. The clock is steady_seconds().
class OnvifServer {
 public:
  /// `device` must outlive this object and is used only under lock(). The `host` in its model is set to the
  /// address of this server. `port`: 0 for any free port. Throws std::runtime_error if the port is taken.
  explicit OnvifServer(OnvifDevice& device, std::uint16_t port = 0);
  /// Ends the thread and closes all connections.
  ~OnvifServer();
  OnvifServer(const OnvifServer&) = delete;
  OnvifServer& operator=(const OnvifServer&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Returns a lock under which the caller may read or change the device.
  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }

 private:
  struct Connection {
    Descriptor socket;
    OnvifStream stream;
    std::vector<OnvifChunk> waiting;
    bool is_over = false;
  };
  void run();
  void accept();
  void take(Connection& one);
  static void send(Connection& one);

  OnvifDevice& device_;
  Descriptor listening_;
  std::uint16_t port_ = 0;
  std::list<Connection> connections_;
  std::mutex mutex_;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace flexura
