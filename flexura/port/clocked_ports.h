#pragma once

#include <limits>
#include <optional>

#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/device_clock.h"
#include "flexura/port/motion_ports.h"

// Adapters for devices whose readings and frames have the time of their own clock. In front of such a port,
// they convert these times to the rig's. They learn the clock from every answer. Devices with one clock may
// share a DeviceClock if one thread calls them.
namespace flexura {

/// Converts a device's times to the rig's. If the device's times do not decrease, the results do not either,
/// except when the previous ones turn out to be too late.
class MappedTime {
 public:
  /// `clock` must outlive this object.
  explicit MappedTime(DeviceClock& clock) : clock_(clock) {}

  /// Returns the rig's time of an answer, for the arguments of DeviceClock::add. Returns the device's time if
  /// nothing can be learned from it.
  double of(double device, double earliest, double latest) {
    (void)clock_.add(device, earliest, latest);
    if (!clock_.is_known()) return device;
    double rig = clock_.rig_time(device);
    if (device >= last_device_ && rig < last_rig_ && last_rig_ <= latest) rig = last_rig_;
    last_device_ = device, last_rig_ = rig;
    return rig;
  }

 private:
  DeviceClock& clock_;
  double last_device_ = std::numeric_limits<double>::infinity(), last_rig_ = 0;
};

/// An arm, a head or a stage with its own clock.
template <class Port, class State, class Reading, class... Way>
class ClockedDevice : public Port {
 public:
  /// A reading was true when it was requested, or up to `age` s before, if the device answers from a cycle.
  /// The other arguments must outlive this object.
  ClockedDevice(Port& port, const ClockPort& rig, DeviceClock& clock, double age = 0)
      : port_(port), rig_(rig), time_(clock), age_(age) {}

  /// Forwards the command to the device.
  CommandOutcome command(const State& state, Way... way) override { return port_.command(state, way...); }
  /// Forwards the halt to the device.
  CommandOutcome halt() override { return port_.halt(); }
  /// Returns the device's reading with the rig's time.
  Outcome<Reading> read() override {
    const double asked = rig_.now();
    auto outcome = port_.read();
    if (!outcome) return outcome;
    Reading reading = outcome.value();
    reading.time = time_.of(reading.time, asked - age_, rig_.now());
    return reading;
  }

 private:
  Port& port_;
  const ClockPort& rig_;
  MappedTime time_;
  double age_;
};

using ClockedArm = ClockedDevice<ArmPort, ArmState, ArmReading, double>;
using ClockedHead = ClockedDevice<HeadPort, HeadState, HeadReading>;
using ClockedStage = ClockedDevice<StagePort, StageState, StageReading>;

/// A camera with its own clock. The frames' `time` is of that clock; `received` is of the rig's clock, from
/// the program that fetches the frames.
class ClockedCamera : public CameraPort {
 public:
  /// A frame is received `quickest` to `slowest` s after the middle of its exposure. `slowest` may be
  /// unknown. The other arguments must outlive this object.
  ClockedCamera(CameraPort& port, DeviceClock& clock, double quickest,
                double slowest = std::numeric_limits<double>::infinity())
      : port_(port), time_(clock), quickest_(quickest), slowest_(slowest) {}

  Outcome<std::optional<Frame>> newest() override { return mapped(port_.newest()); }
  Outcome<std::optional<Frame>> wait(double timeout) override { return mapped(port_.wait(timeout)); }

 private:
  Outcome<std::optional<Frame>> mapped(Outcome<std::optional<Frame>> taken) {
    if (!taken || !taken.value()) return taken;
    Frame frame = *taken.value();
    frame.time = time_.of(frame.time, frame.received - slowest_, frame.received - quickest_);
    return std::optional(frame);
  }
  CameraPort& port_;
  MappedTime time_;
  double quickest_, slowest_;
};

}  // namespace flexura
