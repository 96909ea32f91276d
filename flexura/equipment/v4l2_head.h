#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "flexura/base/fields.h"
#include "flexura/equipment/v4l2_calls.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// Pan, tilt and zoom of a Video4Linux2 camera, by its absolute controls.
struct V4l2HeadConfig {
  std::string device = "/dev/video0";  ///< Path.
  double zoom_step = 1;  ///< Zoom position (HeadState::zoom) per unit of the device's control, > 0.
  double patience =
      2;  ///< Longest time for which an axis may fail to approach its target after a command, s.
};

const Table<V4l2HeadConfig>& fields_of(const V4l2HeadConfig*);

/// A head whose axes are controls of a video device. The resolution of angles is one second of arc, or
/// coarser. An axis without a control is fixed at 0 (zoom: 1), and commands to move it return a fault.
///
/// The controls report positions but not whether an axis moves. So an axis counts as moving until it reports
/// its target position. The function read() returns a fault if an axis does not approach its target for
/// longer than `patience`, because some cameras accept a move without executing it. Since the device has no
/// stop command, halt() commands the present position. All functions may be called from several threads.
class V4l2Head : public HeadPort {
 public:
  /// Opens the device. Fails if the device cannot be opened or has none of the controls. `clock` must outlive
  /// the head.
  [[nodiscard]] static Outcome<std::unique_ptr<V4l2Head>> open(
      const V4l2HeadConfig& config, const std::string& name, const ClockPort& clock,
      const std::shared_ptr<V4l2Calls>& calls = v4l2_system_calls());

  CommandOutcome command(const HeadState& state) override;
  CommandOutcome halt() override;
  Outcome<HeadReading> read() override;

 private:
  struct Axis {
    std::uint32_t control = 0;
    const char* name = "";
    double unit = 1;  // Position per unit of the control.
    double fixed = 0;
    bool exists = false;
    std::int32_t min = 0, max = 0, step = 1;
    std::optional<std::int32_t> target = {};
    std::int64_t nearest = 0;  // Smallest distance to the target so far.
    double progress = 0;       // Time at which it became smaller, s.
  };

  V4l2Head(const V4l2HeadConfig& config, std::string name, const ClockPort& clock,
           const std::shared_ptr<V4l2Calls>& calls);
  [[nodiscard]] PortFault lost(const std::string& what) const;
  [[nodiscard]] PortFault refused(const std::string& what) const;
  [[nodiscard]] std::optional<PortFault> find(Axis& axis);
  [[nodiscard]] Outcome<std::int32_t> value(const Axis& axis);
  [[nodiscard]] std::optional<PortFault> set(Axis& axis, std::int32_t value);
  [[nodiscard]] std::optional<PortFault> check(Axis& axis, std::int32_t value, bool* is_moving);

  const V4l2HeadConfig config_;
  const std::string name_;
  const ClockPort& clock_;
  const std::shared_ptr<V4l2Calls> calls_;
  std::mutex mutex_;
  V4l2Device device_;
  std::array<Axis, 3> axes_;  // Pan, tilt, zoom.
};

}  // namespace flexura
