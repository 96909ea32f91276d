#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "flexura/camera/sensor.h"
#include "flexura/port/clocked_ports.h"
#include "flexura/port/rig_ports.h"
#include "tests/support/altered_ports.h"

namespace flexura {

/// A rig's devices, each of which goes by a clock of its own: one that began at another time and drifts.
class OwnClocks {
 public:
  /// How far each clock is ahead of the one before, s, and by which share it goes faster.
  OwnClocks(const RigPorts& rig, double ahead, double drift) : rig_(rig), own_(rig) {
    double offset = 0;
    const auto shown = [&offset, ahead, drift] {
      offset += ahead;
      return [offset, drift](auto reading) {
        reading.time = offset + (1 + drift) * reading.time;
        return reading;
      };
    };
    own_.arm = &arms_.emplace_back(*rig.arm, shown());
    for (CameraPorts& camera : own_.cameras) {
      camera.head = &heads_.emplace_back(*camera.head, shown());
      camera.stage = &stages_.emplace_back(*camera.stage, shown());
      camera.camera = &cameras_.emplace_back(*camera.camera, shown());
    }
  }

  /// The devices as they are.
  [[nodiscard]] const RigPorts& own() const { return own_; }
  /// The same with the rig's time; `sensors` are the cameras'.
  [[nodiscard]] RigPorts mapped(const std::vector<SensorConfig>& sensors) {
    RigPorts ports = own_;
    ports.arm = &mapped_arms_.emplace_back(*own_.arm, *rig_.clock, clocks_.emplace_back());
    for (std::size_t i = 0; i < ports.cameras.size(); ++i) {
      CameraPorts& camera = ports.cameras[i];
      camera.head = &mapped_heads_.emplace_back(*camera.head, *rig_.clock, clocks_.emplace_back());
      camera.stage = &mapped_stages_.emplace_back(*camera.stage, *rig_.clock, clocks_.emplace_back());
      const FrameTimes times = frame_times(sensors.at(i), 0);
      camera.camera = &mapped_cameras_.emplace_back(*camera.camera, clocks_.emplace_back(),
                                                    times.received - times.middle);
    }
    return ports;
  }

 private:
  using AlteredStage = AlteredDevice<StagePort, StageState, StageReading>;

  RigPorts rig_, own_;
  std::deque<AlteredArm> arms_;
  std::deque<AlteredHead> heads_;
  std::deque<AlteredStage> stages_;
  std::deque<AlteredCamera> cameras_;
  std::deque<DeviceClock> clocks_;
  std::deque<ClockedArm> mapped_arms_;
  std::deque<ClockedHead> mapped_heads_;
  std::deque<ClockedStage> mapped_stages_;
  std::deque<ClockedCamera> mapped_cameras_;
};

}  // namespace flexura
