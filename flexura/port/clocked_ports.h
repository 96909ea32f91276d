#pragma once

#include <limits>
#include <optional>

#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/device_clock.h"
#include "flexura/port/motion_ports.h"

// Devices whose readings and frames have times of their own clock: put before such a port, these give them
// the rig's. The clock is learned on the way, from every answer. Devices that go by one clock may share it,
// as long as one thread asks them.
namespace flexura {

/// Makes the rig's times of a device's. As more is learned they do not go back where the device's do not, but
/// where the ones before turn out to be too late.
class MappedTime {
 public:
  /// The clock outlives this.
  explicit MappedTime(DeviceClock& clock) : clock_(clock) {}

  /// Of an answer, as DeviceClock::add has it; as the device says, where nothing can be learned of it.
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

/// An arm, a head or a stage with a clock of its own.
template <class Port, class State, class Reading, class... Way>
class ClockedDevice : public Port {
 public:
  /// A reading was true when it was asked for, or up to `age` s before: as long as the device lets it stand.
  /// The others outlive this.
  ClockedDevice(Port& port, const ClockPort& rig, DeviceClock& clock, double age = 0)
      : port_(port), rig_(rig), time_(clock), age_(age) {}

  /// As the device's own.
  CommandOutcome command(const State& state, Way... way) override { return port_.command(state, way...); }
  /// Likewise.
  CommandOutcome halt() override { return port_.halt(); }
  /// What the device says, at the rig's time.
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

/// A camera with a clock of its own: `time` of its frames is that clock's, `received` is the rig's, as
/// whoever fetches them knows it.
class ClockedCamera : public CameraPort {
 public:
  /// From the middle of its exposure on it takes a frame from `quickest` to `slowest` s to be received; how
  /// long at most need not be known. The others outlive this.
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
