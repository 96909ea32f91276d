#include "flexura/sim/simulated_head.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace flexura {
namespace {

Eigen::Vector3d vector(const HeadState& state) { return {state.pan, state.tilt, state.zoom}; }
HeadState head_state(const Eigen::Vector3d& positions) { return {positions[0], positions[1], positions[2]}; }

}  // namespace

ThreeAxes::ThreeAxes(SimulatedLink link, const std::array<AxisConfig, 3>& axes,
                     const Eigen::Vector3d& counted, const Eigen::Vector3d& start, double delay,
                     double horizon)
    : link_(std::move(link)), configs_(axes), offset_(start - counted) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double half_backlash = 0.5 * axes[i].backlash;
    axes_.emplace_back(axes[i], AxisMotion::Backlash{-half_backlash, half_backlash},
                       counted[static_cast<Eigen::Index>(i)], delay, horizon);
  }
}

CommandOutcome ThreeAxes::command(const Eigen::Vector3d& target) {
  if (auto fault = link_.fault()) return *fault;
  if (!target.allFinite()) return link_.refusal("a position is not a finite number");
  for (std::size_t i = 0; i < 3; ++i) axes_[i].command(link_.now(), target[static_cast<Eigen::Index>(i)]);
  return Accepted{};
}

CommandOutcome ThreeAxes::halt() {
  if (auto fault = link_.fault()) return *fault;
  for (AxisMotion& axis : axes_) axis.halt(link_.now());
  return Accepted{};
}

Outcome<ThreeAxes::Reading> ThreeAxes::read() const {
  if (auto fault = link_.fault()) return *fault;
  const double now = link_.now();
  Reading reading{now, Eigen::Vector3d::Zero(), false};
  for (std::size_t i = 0; i < 3; ++i) {
    reading.positions[static_cast<Eigen::Index>(i)] = commandable(configs_[i], axes_[i].motor(now));
    reading.moving = reading.moving || axes_[i].is_moving(now);
  }
  return reading;
}

Eigen::Vector3d ThreeAxes::positions(double time) const {
  return offset_ + Eigen::Vector3d(axes_[0].position(time), axes_[1].position(time), axes_[2].position(time));
}

SimulatedHead::SimulatedHead(const Camera& camera, const HeadState& counted, const ClockPort& clock,
                             double horizon)
    : zoom_limits_(camera.head_axes()[2].limits),
      axes_({"the head of camera " + camera.config().name, clock}, camera.head_axes(), vector(counted),
            vector(camera.initial_head()), camera.config().head.delay, horizon) {}

CommandOutcome SimulatedHead::command(const HeadState& state) { return axes_.command(vector(state)); }

Outcome<HeadReading> SimulatedHead::read() {
  const auto reading = axes_.read();
  if (const auto fault = reading.fault()) return *fault;
  return HeadReading{reading.value().time, head_state(reading.value().positions), reading.value().moving};
}

HeadState SimulatedHead::truth(double time) const {
  HeadState state = head_state(axes_.positions(time));
  // Rounding, or an offset, leads past the lens's ends.
  state.zoom = std::clamp(state.zoom, zoom_limits_[0], zoom_limits_[1]);
  return state;
}

SimulatedStage::SimulatedStage(const Camera& camera, const StageState& counted, const ClockPort& clock,
                               double horizon)
    : axes_({"the stage of camera " + camera.config().name, clock}, camera.stage_axes(), counted.offset,
            camera.initial_stage().offset, camera.config().mount.stage.delay, horizon) {}

Outcome<StageReading> SimulatedStage::read() {
  const auto reading = axes_.read();
  if (const auto fault = reading.fault()) return *fault;
  return StageReading{reading.value().time, {reading.value().positions}, reading.value().moving};
}

}  // namespace flexura
