#pragma once

#include <limits>
#include <optional>

#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/device_clock.h"
#include "flexura/port/motion_ports.h"

// Adapters for devices whose readings and frames have times of the device's own clock. An adapter wraps the
// device's port and converts these times to times of the rig's clock. It estimates the relation of the clocks
// from every answer of the device. Devices with a common clock may share a DeviceClock if only one thread
// calls them.
namespace flexura {

/// Converts times of a device's clock to times of the rig's clock. If the device's times do not decrease, the
/// results do not decrease either. The results decrease only if previous results turn out to be too late.
class MappedTime {
 public:
  /// `clock` must outlive this object.
  explicit MappedTime(DeviceClock& clock) : clock_(clock) {}

  /// Returns the time of an answer on the rig's clock, s. The parameters are as for DeviceClock::add(). While
  /// the relation of the clocks is unknown, returns `device`.
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

/// Port of an arm, a head or a stage that has its own clock.
template <class Port, class State, class Reading, class... Way>
class ClockedDevice : public Port {
 public:
  /// `age`: largest age of a reading at the time of the request, s. This age is above 0 for a device that
  /// reports its last cyclic measurement. The other arguments must outlive this object.
  ClockedDevice(Port& port, const ClockPort& rig, DeviceClock& clock, double age = 0)
      : port_(port), rig_(rig), time_(clock), age_(age) {}

  /// Forwards the command to the device.
  CommandOutcome command(const State& state, Way... way) override { return port_.command(state, way...); }
  /// Forwards the halt to the device.
  CommandOutcome halt() override { return port_.halt(); }
  /// Returns the device's reading, with the time converted to the rig's clock.
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

/// Port of a camera that has its own clock. In the wrapped port's frames, `time` is on the camera's clock.
/// The program that fetches the frames sets `received` on the rig's clock.
class ClockedCamera : public CameraPort {
 public:
  /// A frame is received `quickest` to `slowest` s after the middle of its exposure. `slowest` is infinite if
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
