#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "flexura/camera/head.h"
#include "flexura/equipment/device_access.h"
#include "flexura/equipment/device_server.h"
#include "flexura/equipment/onvif_device.h"
#include "flexura/equipment/rig_equipment.h"
#include "flexura/equipment/sent_text.h"

namespace flexura {

/// A message that a driver sends to a simulated device, in place of a real device.
struct DryMessage {
  double time = 0;     ///< Time on the clock of the devices, s.
  std::string device;  ///< Address of the link.
  std::string bytes;   ///< Bytes of the message; "" for a system call.
  SentText sent;       ///< Message in readable form.
};
/// Function that receives the messages, in order.
using TakeDryMessage = std::function<void(const DryMessage&)>;

/// Time that passes only when a driver waits for its device.
class DryClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return time_; }
  void wait_until(double time) override;

 private:
  double time_ = 0;
};

/// Simulated devices in place of all devices of a file, without any real connection. Drivers use these
/// devices in simulated time, and every message that a driver sends is reported. Only one thread may use this
/// object.
class DryDevices : public DeviceAccess {
 public:
  /// `axes`: number of motors. `motors`: motor positions at the start, microsteps, one per axis. `heads`:
  /// initial position of the head of each camera in `equipment`, in their order. The equipment must outlive
  /// this object.
  DryDevices(const RigEquipment& equipment, std::vector<double> motors, std::vector<HeadState> heads,
             TakeDryMessage take);
  ~DryDevices() override;

  [[nodiscard]] DryClock& clock() override { return clock_; }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const GrblConfig& config) override;
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const Cia402Config& config) override;
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const ViscaBusConfig& config) override;
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const OnvifConfig& config) override;
  [[nodiscard]] std::shared_ptr<V4l2Calls> calls(const V4l2HeadConfig& config) override;
  [[nodiscard]] bool wants_logins() const override { return false; }
  [[nodiscard]] Guard* guard() override { return nullptr; }

  /// Returns the assumptions about the real devices that the simulated devices make, one sentence each.
  [[nodiscard]] std::vector<std::string> assumptions() const;

 private:
  class Connection;
  class Calls;
  using Reader = std::function<std::vector<SentText>(std::string_view)>;
  std::unique_ptr<Link> connect(const std::string& address, std::unique_ptr<ServedDevice> device,
                                Reader reader);
  void report(const std::string& device, std::string_view bytes, const SentText& sent) {
    take_({clock_.now(), device, std::string(bytes), sent});
  }

  const RigEquipment& equipment_;
  std::vector<double> motors_;
  std::vector<HeadState> heads_;
  TakeDryMessage take_;
  DryClock clock_;
  std::vector<std::unique_ptr<ServedDevice>> devices_;
  std::map<std::string, std::unique_ptr<OnvifDevice>> onvif_;  // By their addresses.
};

}  // namespace flexura
