#include "flexura/port/rig_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flexura {
namespace {

bool is_finite(const ArmReading& reading) {
  return std::ranges::all_of(reading.state.bends,
                             [](const Eigen::Vector2d& bend) { return bend.allFinite(); }) &&
         std::ranges::all_of(reading.state.stretches, [](double stretch) { return std::isfinite(stretch); });
}

bool is_finite(const HeadReading& head) {
  return std::isfinite(head.time) && std::isfinite(head.state.pan) && std::isfinite(head.state.tilt) &&
         std::isfinite(head.state.zoom);
}

// Returns the stage's reading; without a stage, the initial state at time `now`.
Outcome<StageReading> stage_reading(const CameraPorts& ports, const Camera& optics, double now) {
  if (ports.stage != nullptr) return ports.stage->read();
  return StageReading{now, optics.initial_stage(), false};
}

Outcome<HeadReading> head_reading(const CameraPorts& ports, const Camera& optics,
                                  const Outcome<StageReading>& stage) {
  if (ports.head != nullptr) return ports.head->read();
  if (const auto fault = stage.fault()) return HeadReading{0, optics.initial_head(), false};
  return HeadReading{stage.value().time, optics.initial_head(), false};
}

}  // namespace

std::variant<ArmReading, std::string> read_arm(ArmPort& arm, std::size_t sections) {
  auto outcome = arm.read();
  if (const auto fault = outcome.fault()) return "the arm: " + text(*fault);
  const ArmReading& reading = outcome.value();
  if (!std::isfinite(reading.time)) return "the arm's timestamp is not finite";
  if (!is_finite(reading)) return "the arm's readings are not finite";
  if (reading.state.bends.size() != sections || reading.state.stretches.size() != sections)
    return fmt::format("the arm's drives report {} sections and {} stretches: expected {}",
                       reading.state.bends.size(), reading.state.stretches.size(), sections);
  return reading;
}

std::variant<StanceReading, std::string> read_camera(const RigPorts& rig, std::size_t camera,
                                                     const Camera& optics) {
  const CameraPorts& ports = rig.cameras[camera];
  const auto stage = stage_reading(ports, optics, rig.clock->now());
  const auto head = head_reading(ports, optics, stage);
  if (const auto fault = head.fault())
    return fmt::format("the head of camera {}: {}", ports.name, text(*fault));
  if (const auto fault = stage.fault())
    return fmt::format("the stage of camera {}: {}", ports.name, text(*fault));
  if (!is_finite(head.value()) || !std::isfinite(stage.value().time) ||
      !stage.value().state.offset.allFinite())
    return fmt::format("camera {}: the readings of its head or stage are not finite", ports.name);
  HeadState state = head.value().state;
  const ZoomTable& lens = optics.lens();
  if (lens.is_linear() && !(state.zoom > 0))
    return fmt::format("the head of camera {} reports a zoom of {:.6g}: expected a zoom above 0", ports.name,
                       state.zoom);
  const double known = std::clamp(state.zoom, lens.first(), lens.last());
  constexpr double rounding = 1e-6;
  if (std::abs(state.zoom - known) > optics.head_axes()[2].resolution + rounding * std::abs(known))
    return fmt::format(
        "the head of camera {} reports a zoom of {:.6g}, but the lens's table is from {:.6g} to {:.6g}",
        ports.name, state.zoom, lens.first(), lens.last());
  state.zoom = known;
  return StanceReading{
      head.value().time, {camera, state, stage.value().state}, head.value().moving || stage.value().moving};
}

}  // namespace flexura
