#include "flexura/view/viewed_rig.h"

#include <algorithm>
#include <utility>

#include "flexura/kinematics/shape.h"
#include "flexura/model/backbone.h"
#include "flexura/sim/rig_config.h"

namespace flexura {
namespace {

// What lies `part` of the way from one instant to the next.
Instant between_instants(const Instant& a, const Instant& b, double part) {
  Instant at;
  at.arm = interpolate(a.arm, b.arm, part);
  const auto mix = [&](double from, double to) { return from + part * (to - from); };
  at.head = {mix(a.head.pan, b.head.pan), mix(a.head.tilt, b.head.tilt), mix(a.head.zoom, b.head.zoom)};
  at.stage.offset = a.stage.offset + part * (b.stage.offset - a.stage.offset);
  return at;
}

bool stand_alike(const Instant& a, const Instant& b) {
  return a.arm.bends == b.arm.bends && a.arm.stretches == b.arm.stretches && a.head == b.head &&
         a.stage == b.stage;
}

Instant instant_at(const std::vector<Instant>& instants, double time) {
  const auto after = std::ranges::upper_bound(instants, time, {}, &Instant::time);
  if (after == instants.begin()) return instants.front();
  if (after == instants.end()) return instants.back();
  const Instant& before = *(after - 1);
  return between_instants(before, *after, (time - before.time) / (after->time - before.time));
}

}  // namespace

ViewedRig::ViewedRig(Experiment read)
    : experiment(std::move(read)),
      model(experiment.arm.arm()),
      truth(experiment.true_rig().arm.arm()),
      initial(ArmSetup(experiment.true_rig()).initial),
      obstacles(flexura::obstacles(experiment.obstacle)) {
  if (experiment.drive) drive = experiment.drive->drive();
  for (const CameraConfig& config : experiment.true_rig().cameras) {
    cameras.emplace_back(config);
    sensors.push_back(config.sensor);
  }
}

std::optional<std::size_t> ViewedRig::camera(std::string_view name) const {
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (cameras[i].config().name == name) return i;
  return std::nullopt;
}

CameraSample camera_sample(const Camera& camera, const StageState& stage, const HeadState& head) {
  const View view = camera.view(stage, head);
  const Intrinsics& lens = view.lens.intrinsics();
  return {view.X_WC, head, stage.offset, lens.fx, lens.fy, lens.cx, lens.cy};
}

ValueShot value_shot(const ViewedRigPtr& rig, std::size_t camera, std::int64_t frame, double start,
                     std::vector<Instant> instants) {
  const auto shown = std::make_shared<const std::vector<Instant>>(std::move(instants));
  Shot shot;
  shot.camera = camera;
  shot.frame = frame;
  shot.seed = static_cast<std::uint64_t>(rig->experiment.seed);
  shot.start = start;
  shot.sensor = &rig->sensors.at(camera);
  shot.view = [rig, camera, shown](double time) {
    const Instant at = instant_at(*shown, time);
    return rig->cameras[camera].view(at.stage, at.head);
  };
  shot.backbone = [rig, shown](double time) { return Backbone(rig->truth, instant_at(*shown, time).arm); };
  return {std::move(shot), shown};
}

bool show_the_same(const ValueShot& a, const ValueShot& b) {
  const SensorConfig& sensor = *a.shot.sensor;
  if (a.shot.camera != b.shot.camera || sensor.full_well > 0 || sensor.read_noise > 0) return false;
  const Instant& first = a.instants->front();
  const auto is_first = [&](const Instant& instant) { return stand_alike(instant, first); };
  return std::ranges::all_of(*a.instants, is_first) && std::ranges::all_of(*b.instants, is_first);
}

std::vector<double> times_of_instants(const SensorConfig& sensor, double start) {
  constexpr int intervals = 16;
  const FrameTimes times = times_of_frame_at(sensor, start);
  if (!(times.end > times.start)) return {times.start};
  std::vector<double> instants;
  for (int i = 0; i <= intervals; ++i)
    instants.push_back(times.start + (times.end - times.start) * i / intervals);
  return instants;
}

}  // namespace flexura
