#include "flexura/experiment/filming.h"

#include <cstddef>
#include <cstdint>
#include <limits>

#include "flexura/sim/simulated_camera.h"

namespace flexura {

Filming::Filming(const Experiment& experiment)
    : photographer_(experiment.true_rig().arm.arm(), experiment),
      rig_(
          experiment.model_rig(), experiment.true_rig(),
          [this](const Shot& shot) { return photographer_.take(shot); },
          static_cast<std::uint64_t>(experiment.seed)),
      cameras_(experiment.true_rig().cameras),
      frames_(cameras_.size(), 0) {}

Filming::Next Filming::next() const {
  Next first{0, 0, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const double received = frame_times(cameras_[i].sensor, frames_[i]).received;
    if (received < first.received) first = {i, frames_[i], received};
  }
  return first;
}

void Filming::play_to(double time, const ArmState& state, const TakeFrame& take) {
  const RigPorts ports = rig_.ports();
  // The simulated rig has no links that are lost: a fault here is a fault of the program.
  (void)ports.arm->command(state, time - ports.clock->now()).value();
  for (Next frame = next(); frame.received <= time; frame = next()) {
    ports.clock->wait_until(frame.received);
    const auto received = ports.cameras[frame.camera].camera->newest().value();
    if (received) take(ports.cameras[frame.camera].name, *received);
    ++frames_[frame.camera];
  }
  ports.clock->wait_until(time);
}

}  // namespace flexura
