#include "flexura/experiment/filming.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "flexura/safety/motion_check.h"
#include "flexura/sim/simulated_camera.h"

namespace flexura {

Filming::Filming(const Experiment& experiment)
    : photographer_(experiment),
      rig_(
          experiment.model_rig(), experiment.true_rig(),
          [this](const Shot& shot) { return photographer_.take(shot); },
          static_cast<std::uint64_t>(experiment.seed)),
      seed_(static_cast<std::uint64_t>(experiment.seed)),
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

void Filming::pass_to(double time, const ArmState& state) {
  const RigPorts ports = rig_.ports();
  (void)ports.arm->command(state, time - ports.clock->now()).value();
  ports.clock->wait_until(time);
}

void Filming::skip_to_now() {
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    while (frame_times(cameras_[i].sensor, frames_[i]).received <= rig_.clock().now()) ++frames_[i];
}

RigStance Filming::true_stance(std::size_t camera) {
  const double now = rig_.clock().now();
  return {camera, rig_.camera(camera).head().truth(now), rig_.camera(camera).stage().truth(now)};
}

std::vector<CameraReading> Filming::camera_readings() {
  std::vector<CameraReading> readings;
  for (const CameraPorts& camera : ports().cameras)
    readings.push_back({camera.head->read().value().state, camera.stage->read().value().state});
  return readings;
}

double Filming::play_to(double until, const Schedule& schedule) {
  const RigPorts ports = rig_.ports();
  double played = 0;
  for (std::size_t step = 0; step <= schedule.steps(); ++step) {
    const double time = schedule.time_of_step(step);
    const ArmState state = schedule.state_at(time);
    if (!is_possible(state)) break;
    (void)ports.arm->command(state, time - ports.clock->now()).value();
    ports.clock->wait_until(time);
    played = time;
    if (time >= until) break;
  }
  return played;
}

Shot Filming::shot(std::size_t camera, double start) {
  Shot shot;
  shot.camera = camera;
  shot.sensor = &cameras_.at(camera).sensor;
  shot.frame = std::llround(start * shot.sensor->frame_rate);
  shot.seed = seed_;
  shot.start = start;
  shot.view = [&seen = rig_.camera(camera)](double time) { return seen.view(time); };
  shot.backbone = [this](double time) { return rig_.arm().backbone(time); };
  return shot;
}

}  // namespace flexura
