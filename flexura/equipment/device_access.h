#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "flexura/equipment/cia402_config.h"
#include "flexura/equipment/grbl_config.h"
#include "flexura/equipment/guard.h"
#include "flexura/equipment/link.h"
#include "flexura/equipment/onvif_config.h"
#include "flexura/equipment/v4l2_calls.h"
#include "flexura/equipment/v4l2_head.h"
#include "flexura/equipment/visca_config.h"
#include "flexura/equipment/wall_clock.h"
#include "flexura/port/clock_port.h"

namespace flexura {

/// Opens the links of drivers to their devices: to real devices at the configured addresses, or to simulated
/// devices.
class DeviceAccess {
 public:
  virtual ~DeviceAccess() = default;
  DeviceAccess() = default;
  DeviceAccess(const DeviceAccess&) = delete;
  DeviceAccess& operator=(const DeviceAccess&) = delete;

  /// Returns the clock of drives and heads.
  [[nodiscard]] virtual ClockPort& clock() = 0;
  /// @{ Opens the link to a controller, to a bus of drives, to a chain of heads, or to an ONVIF camera.
  [[nodiscard]] virtual Outcome<std::unique_ptr<Link>> open(const GrblConfig& config) = 0;
  [[nodiscard]] virtual Outcome<std::unique_ptr<Link>> open(const Cia402Config& config) = 0;
  [[nodiscard]] virtual Outcome<std::unique_ptr<Link>> open(const ViscaBusConfig& config) = 0;
  [[nodiscard]] virtual Outcome<std::unique_ptr<Link>> open(const OnvifConfig& config) = 0;
  /// @}
  /// Returns the system calls for a head with Video4Linux2 controls.
  [[nodiscard]] virtual std::shared_ptr<V4l2Calls> calls(const V4l2HeadConfig& config) = 0;
  /// Returns whether the devices require the logins of the configurations. Simulated devices do not.
  [[nodiscard]] virtual bool wants_logins() const { return true; }
  /// Returns the guard that stops the devices when this program dies or hangs; null if nothing can move.
  [[nodiscard]] virtual Guard* guard() = 0;
  /// Returns whether the user has asked the program to stop. Homing then ends.
  [[nodiscard]] virtual bool is_cancelled() const { return false; }
};

/// Real devices, at the configured addresses.
class RealDevices : public DeviceAccess {
 public:
  /// Opens devices without a guard. Use this constructor only if nothing will move.
  RealDevices() = default;
  /// Opens devices that a guard protects. `watchdog`: period of the guard, s, > 0. Throws like Guard.
  /// `is_cancelled`: returns whether the user has asked the program to stop; empty: never.
  explicit RealDevices(double watchdog, std::function<bool()> is_cancelled = {})
      : guard_(std::in_place, watchdog), is_cancelled_(std::move(is_cancelled)) {}

  [[nodiscard]] WallClock& clock() override { return clock_; }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const GrblConfig& config) override {
    return open_link(parse_link_address(config.link));
  }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const Cia402Config& config) override {
    return open_link(parse_link_address(config.link));
  }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const ViscaBusConfig& config) override {
    return open_link(parse_link_address(config.link));
  }
  [[nodiscard]] Outcome<std::unique_ptr<Link>> open(const OnvifConfig& config) override {
    return open_link(parse_link_address(config.link), config.reply_timeout);
  }
  [[nodiscard]] std::shared_ptr<V4l2Calls> calls(const V4l2HeadConfig& /*config*/) override {
    return v4l2_system_calls();
  }
  [[nodiscard]] Guard* guard() override { return guard_ ? &*guard_ : nullptr; }
  [[nodiscard]] bool is_cancelled() const override { return is_cancelled_ && is_cancelled_(); }

 private:
  std::optional<Guard> guard_;
  std::function<bool()> is_cancelled_;
  WallClock clock_;
};

}  // namespace flexura
