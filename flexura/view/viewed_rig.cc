#include "flexura/view/viewed_rig.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <variant>

#include "flexura/math/so3.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/arm_difference.h"
#include "flexura/model/backbone.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/rig_config.h"

namespace flexura {
namespace {

// Rounds to two digits, for display.
double rounded(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::round(value / digit) * digit;
}

// The instants before and after a time, at fraction `part` between them; or a single instant.
struct Between {
  const Instant &from, &to;
  double part = 0;

  [[nodiscard]] bool is_one() const { return &from == &to; }
};

// Interpolates between two shapes of a rod. Both have samples at the same places along it, with two arcs
// between consecutive samples.
Backbone between_shapes(const Backbone& a, const Backbone& b, double part) {
  const std::span<const Arc> from = a.arcs(), to = b.arcs();
  if (from.size() != to.size() || from.size() % 2 != 0) return part < 0.5 ? a : b;
  std::vector<BackboneSample> samples;
  samples.reserve(from.size() / 2 + 1);
  for (std::size_t i = 0; i < from.size(); i += 2)
    samples.push_back(
        {interpolate(from[i].X_WS, to[i].X_WS, part), from[i].s_rest, from[i].radius[0], from[i].section});
  samples.push_back({interpolate(a.tip(), b.tip(), part), from.back().s_rest + from.back().rest_length,
                     from.back().radius[1], from.back().section});
  return Backbone::through(samples);
}

// Returns `from` plus the difference between two states.
HeadState plus_way(const HeadState& from, const HeadState& a, const HeadState& b) {
  return {from.pan + b.pan - a.pan, from.tilt + b.tilt - a.tilt, from.zoom + b.zoom - a.zoom};
}

// Clamps a zoom to the lens, since rounding or an offset can lead beyond its limits.
double on_lens(const Camera& camera, double zoom) {
  const auto [least, most] = camera.head_axes()[2].limits;
  return std::clamp(zoom, least, most);
}

// Clamps readings to the axis limits, since a log may contain any values.
CameraReading within_ends(const Camera& camera, CameraReading reading) {
  const auto draw = [](const AxisConfig& axis, double& position) {
    position = std::clamp(position, axis.limits[0], axis.limits[1]);
  };
  const auto& [pan, tilt, zoom] = camera.head_axes();
  draw(pan, reading.head.pan), draw(tilt, reading.head.tilt), draw(zoom, reading.head.zoom);
  for (std::size_t i = 0; i < camera.stage_axes().size(); ++i)
    draw(camera.stage_axes()[i], reading.stage.offset[static_cast<Eigen::Index>(i)]);
  return reading;
}

// Compares two rods. At rest they may differ in the last digits of the equilibrium, which no picture shows.
bool lie_alike(const Instant& a, const Instant& b) {
  constexpr double unseen = 1e-7;  // m
  if (a.shape == b.shape) return true;
  if (a.shape == nullptr || b.shape == nullptr) return false;
  const auto is_near = [](const Arc& one, const Arc& other) {
    return (one.X_WS.position - other.X_WS.position).norm() <= unseen;
  };
  return std::ranges::equal(a.shape->arcs(), b.shape->arcs(), is_near) &&
         (a.shape->tip().position - b.shape->tip().position).norm() <= unseen;
}

bool stand_alike(const Instant& a, const Instant& b) {
  return a.arm == b.arm && a.stance == b.stance && lie_alike(a, b);
}

Between between(const std::vector<Instant>& instants, double time) {
  const auto after = std::ranges::upper_bound(instants, time, {}, &Instant::time);
  if (after == instants.begin()) return {instants.front(), instants.front()};
  if (after == instants.end()) return {instants.back(), instants.back()};
  const Instant& before = *(after - 1);
  return {before, *after, (time - before.time) / (after->time - before.time)};
}

CameraStance stance_at(const std::vector<Instant>& instants, double time) {
  const Between at = between(instants, time);
  return at.is_one() ? at.from.stance : interpolate(at.from.stance, at.to.stance, at.part);
}

Backbone backbone_at(const ViewedRig& rig, const std::vector<Instant>& instants, double time) {
  const Between at = between(instants, time);
  const auto &from = at.from.shape, &to = at.to.shape;
  if (from != nullptr && to != nullptr) return from == to ? *from : between_shapes(*from, *to, at.part);
  return rig.truth.backbone(at.is_one() ? at.from.arm : interpolate(at.from.arm, at.to.arm, at.part));
}

// Returns the tip's displacement per newton of transverse force in the initial state, m/N. The force is large
// enough to tighten tendons that are slack there. Returns 0 if unknown.
double compliance_of(const ArmSetup& setup) {
  constexpr double little = 0.05;  // Fraction of the arm's length, for the arm without tendons.
  const Rod& rod = setup.rod->rod;
  RodStatics statics(rod);
  const TendonInput tendons{.displacements = arc_displacements(rod, setup.initial).pulled};
  const Equilibrium start = statics.solve(tendons, setup.rod->loads);
  if (!start.converged()) return 0;
  const double freely = statics.slopes().tip_by_tip.topLeftCorner<3, 3>().norm();
  if (!(freely > 0)) return 0;
  const double force = little * rod.length() / freely;
  double most = 0;
  for (const int axis : {0, 1}) {
    RodLoads loads = setup.rod->loads;
    loads.ends.push_back({.section = rod.sections.size() - 1, .force = force * start.tip.rotation.col(axis)});
    const Equilibrium moved = statics.solve(tendons, loads, start);
    if (moved.converged()) most = std::max(most, (moved.tip.position - start.tip.position).norm() / force);
  }
  return most > 0 ? most : freely;
}

std::optional<PushScale> push_scale(const ArmSetup& setup) {
  const double compliance = compliance_of(setup), length = setup.rod->rod.length();
  if (!(compliance > 0) || !std::isfinite(compliance)) return std::nullopt;
  return PushScale{length, rounded(5 / compliance), rounded(length / compliance)};
}

}  // namespace

ViewedRig::ViewedRig(Experiment read)
    : experiment(std::move(read)),
      model(experiment.arm_model()),
      truth(experiment.true_rig().arm.model()),
      initial(ArmSetup(experiment.true_rig()).initial),
      is_rod(experiment.true_rig().arm.mechanics != ArmMechanics::kinematic),
      obstacles(flexura::obstacles(experiment.obstacle)) {
  if (const ArmSetup setup(experiment.true_rig()); setup.rod) {
    actuators = pulled_tendons(setup);
    has_weight = has_loads(setup.rod->loads);
    has_inertia = setup.rod->time_step.has_value();
    touches = setup.rod->contact.has_value();
    push = push_scale(setup);
  }
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    if (!std::visit([](const auto& config) { return config.may_touch; }, experiment.obstacle[i]))
      forbidden.push_back(obstacles[i]);
  if (experiment.drive) drive = experiment.drive->drive();
  for (const CameraConfig& config : experiment.true_rig().cameras) {
    cameras.emplace_back(config);
    sensors.push_back(config.sensor);
  }
  for (const CameraConfig& config : experiment.model_rig().cameras) nominal.emplace_back(config);
}

std::optional<std::size_t> ViewedRig::camera(std::string_view name) const {
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (cameras[i].config().name == name) return i;
  return std::nullopt;
}

CameraReading ViewedRig::first_reading(std::size_t camera) const {
  return {nominal.at(camera).initial_head(), nominal.at(camera).initial_stage()};
}

CameraStance ViewedRig::first_stance(std::size_t camera) const { return cameras.at(camera).initial_stance(); }

CameraStance ViewedRig::stance(std::size_t camera, const CameraReading& reading) const {
  const CameraReading read = within_ends(cameras.at(camera), reading), first = first_reading(camera);
  const CameraStance start = first_stance(camera);
  CameraStance stance{plus_way(start.head, first.head, read.head),
                      {start.stage.offset + read.stage.offset - first.stage.offset}};
  stance.head.zoom = on_lens(cameras.at(camera), stance.head.zoom);
  return stance;
}

CameraReading ViewedRig::reading(std::size_t camera, const CameraStance& stance) const {
  const CameraReading first = first_reading(camera);
  const CameraStance start = first_stance(camera);
  return {plus_way(first.head, start.head, stance.head),
          {first.stage.offset + stance.stage.offset - start.stage.offset}};
}

View ViewedRig::nominal_view(std::size_t camera, const CameraReading& reading) const {
  const Camera& described = nominal.at(camera);
  HeadState head = reading.head;
  head.zoom = on_lens(described, head.zoom);
  return described.view({head, reading.stage});
}

Pose interpolate(const Pose& from, const Pose& to, double part) {
  const Eigen::Vector3d turn = so3_log(from.rotation.transpose() * to.rotation);
  return {from.rotation * so3_exp(part * turn), from.position + part * (to.position - from.position)};
}

CameraSample camera_sample(const ViewedRig& rig, std::size_t camera, const CameraStance& stance) {
  const View view = rig.cameras.at(camera).view(stance);
  const Intrinsics& lens = view.lens.intrinsics();
  const CameraReading reported = rig.reading(camera, stance);
  return {view.X_WC, stance.head,   stance.stage.offset,  lens.fx, lens.fy, lens.cx,
          lens.cy,   reported.head, reported.stage.offset};
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
    return rig->cameras[camera].view(stance_at(*shown, time));
  };
  shot.backbone = [rig, shown](double time) { return backbone_at(*rig, *shown, time); };
  return {std::move(shot), shown};
}

ValueShot with_covers(ValueShot shot, double time) {
  shot.shot.is_covered = is_within(time, shot.shot.sensor->covered);
  return shot;
}

CameraStance stance_in(const ValueShot& shot) {
  const double middle = times_of_frame_at(*shot.shot.sensor, shot.shot.start).middle;
  return stance_at(*shot.instants, middle);
}

bool show_the_same(const ValueShot& a, const ValueShot& b) {
  const SensorConfig& sensor = *a.shot.sensor;
  if (a.shot.camera != b.shot.camera || a.shot.is_covered != b.shot.is_covered) return false;
  if (sensor.full_well > 0 || sensor.read_noise > 0) return false;
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
