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

/// A simulated device, which implements the device's side of a protocol. A ServedDevice has neither a thread
/// nor a clock: the caller passes messages and the time.
class ServedDevice {
 public:
  virtual ~ServedDevice() = default;
  ServedDevice() = default;
  ServedDevice(const ServedDevice&) = delete;
  ServedDevice& operator=(const ServedDevice&) = delete;

  /// Processes bytes that arrive at time `now`, s, not before the time of the previous call. The bytes are
  /// any part of a stream, or one datagram. Returns the messages that the device sends, in order.
  virtual std::vector<std::string> receive(std::string_view bytes, double now) = 0;
  /// Returns the messages that the device sends on its own at time `now`, s. This function must be called
  /// every few milliseconds.
  virtual std::vector<std::string> advance(double now) = 0;
};

/// Runs a simulated device at one end of a link, in a separate thread and in real time, until this object is
/// destroyed.
class DeviceServer {
 public:
  /// `device` must outlive this object and is used only under lock(). `seed`: seed of the random faults.
  DeviceServer(std::unique_ptr<Link> link, ServedDevice& device, const LinkFaults& faults = {},
               std::uint64_t seed = 1);
  /// Ends the thread and closes the link.
  ~DeviceServer();
  DeviceServer(const DeviceServer&) = delete;
  DeviceServer& operator=(const DeviceServer&) = delete;

  /// Returns a lock under which the caller may read or change the device.
  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }
  /// Returns the present time on the clock of the device, s.
  [[nodiscard]] static double now();
  /// While true, the device neither receives nor sends messages, as if its cable were unplugged.
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
  std::unique_ptr<Link> device;  ///< Receives from every sender, and answers the last sender.
  std::uint16_t port = 0;        ///< Number of the port.
};
/// Opens a UDP port of the loopback interface; 0: any free port. Throws std::runtime_error if the port is in
/// use.
[[nodiscard]] UdpPlace open_udp_place(std::uint16_t port = 0);

}  // namespace flexura
