#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "flexura/equipment/link.h"
#include "flexura/equipment/link_faults.h"

namespace flexura {

/// The device's side of a protocol: a simulated device that answers as a real one does. It needs no thread
/// and no clock of its own.
class ServedDevice {
 public:
  virtual ~ServedDevice() = default;
  ServedDevice() = default;
  ServedDevice(const ServedDevice&) = delete;
  ServedDevice& operator=(const ServedDevice&) = delete;

  /// Takes bytes that arrive at time `now`, s, >= that of the previous call; any part of a stream, or one
  /// datagram. Returns the messages that the device sends, in order.
  virtual std::vector<std::string> receive(std::string_view bytes, double now) = 0;
  /// Returns the messages that the device sends unasked at time `now`, s. Called every few milliseconds.
  virtual std::vector<std::string> advance(double now) = 0;
};

/// Runs a simulated device at one end of a link, in a thread of its own and in real time, until the server's
/// end.
class DeviceServer {
 public:
  /// `device` must outlive this object and is only used under lock(). `seed` is that of the faults.
  DeviceServer(std::unique_ptr<Link> link, ServedDevice& device, const LinkFaults& faults = {},
               std::uint64_t seed = 1);
  /// Ends the thread and closes the link.
  ~DeviceServer();
  DeviceServer(const DeviceServer&) = delete;
  DeviceServer& operator=(const DeviceServer&) = delete;

  /// Returns a lock under which the device may be looked at or changed.
  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }
  /// Returns the time that the device is given now, s.
  [[nodiscard]] static double now();
  /// While true, the device neither hears nor says anything, as if its cable were pulled out.
  void set_silent(bool is_silent) { is_silent_ = is_silent; }
  /// Replaces the faults.
  void set_faults(const LinkFaults& faults);

 private:
  void run(std::uint64_t seed);

  std::unique_ptr<Link> link_;
  ServedDevice& device_;
  std::mutex mutex_;
  LinkFaults faults_;
  std::atomic<bool> is_silent_ = false, is_over_ = false;
  std::thread thread_;
};

/// A UDP port on this machine for a simulated device.
struct UdpPlace {
  std::unique_ptr<Link> device;  ///< Hears every sender; answers the last one.
  std::uint16_t port = 0;        ///< Its number.
};
/// Opens a UDP port of the loopback interface; 0: any that is free. Throws std::runtime_error if it is taken.
[[nodiscard]] UdpPlace open_udp_place(std::uint16_t port = 0);

}  // namespace flexura
