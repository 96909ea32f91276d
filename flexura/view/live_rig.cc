#include "flexura/view/live_rig.h"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/kinematics/motors.h"
#include "flexura/kinematics/tendons.h"

namespace flexura {
namespace {

// The rig's own cameras are never asked for frames: pictures are made of value_shot elsewhere.
Picture no_picture(const Shot& /*shot*/) {
  throw std::logic_error("the live rig's pictures are taken elsewhere");
}

}  // namespace

LiveRig::LiveRig(ViewedRigPtr rig, double now) : rig_(std::move(rig)) { restart(now); }

void LiveRig::restart(double now) {
  simulated_ = std::make_unique<SimulatedRig>(rig_->experiment.model_rig(), rig_->experiment.true_rig(),
                                              no_picture, static_cast<std::uint64_t>(rig_->experiment.seed));
  go_to(now);
}

// The simulated rig has no links that are lost: a fault here is a fault of the program.
ArmState LiveRig::believed() { return simulated_->arm().read().value().state; }
bool LiveRig::is_arm_moving() { return simulated_->arm().read().value().moving; }

StateMessage LiveRig::state() {
  StateMessage message;
  message.time = now();
  const ArmReading reading = simulated_->arm().read().value();
  message.is_moving = reading.moving;
  message.arm = truth(message.time);
  message.samples = arm_samples(rig_->truth.backbone(message.arm));
  for (std::size_t i = 0; i < rig_->cameras.size(); ++i) {
    const CameraStance stance = simulated_->camera(i).stance(message.time);
    message.cameras.push_back(camera_sample(rig_->cameras[i], stance));
  }
  if (rig_->drive) {
    const std::vector<double> positions(reading.positions.begin(), reading.positions.end());
    message.displacements = displacements_at(*rig_->drive, positions).pulled;
  }
  return message;
}

std::int64_t LiveRig::newest_frame(std::size_t camera) {
  const SensorConfig& sensor = rig_->sensors.at(camera);
  const FrameTimes first = frame_times(sensor, 0);
  return static_cast<std::int64_t>(std::floor((now() - first.end) * sensor.frame_rate + 1e-9));
}

ValueShot LiveRig::shot(std::size_t camera, std::int64_t frame) {
  const double start = frame_times(rig_->sensors.at(camera), frame).start;
  SimulatedView& view = simulated_->camera(camera);
  std::vector<Instant> instants;
  for (const double time : times_of_instants(rig_->sensors[camera], start))
    instants.push_back({time, truth(time), view.stance(time)});
  return value_shot(rig_, camera, frame, start, std::move(instants));
}

StateMessage still_state(const ViewedRig& rig, double time, const ArmState& state,
                         const std::vector<CameraStance>& stances) {
  StateMessage message;
  message.time = time;
  message.arm = state;
  message.samples = arm_samples(rig.model.backbone(state));
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    message.cameras.push_back(camera_sample(rig.cameras[i], stances.at(i)));
  if (rig.drive) message.displacements = tendon_displacements(rig.model.driven(), *rig.drive, state).pulled;
  return message;
}

}  // namespace flexura
