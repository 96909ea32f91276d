#include "flexura/sim/simulated_head.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flexura {
namespace {

Eigen::Vector3d vector(const HeadState& state) { return {state.pan, state.tilt, state.zoom}; }
HeadState head_state(const Eigen::Vector3d& positions) { return {positions[0], positions[1], positions[2]}; }

}  // namespace

ThreeAxes::ThreeAxes(const std::array<AxisConfig, 3>& axes, const Eigen::Vector3d& start, double delay,
                     double horizon)
    : configs_(axes) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double play = 0.5 * axes[i].backlash;
    axes_.emplace_back(axes[i], AxisMotion::Play{-play, play}, start[static_cast<Eigen::Index>(i)], delay,
                       horizon);
  }
}

void ThreeAxes::command(double time, const Eigen::Vector3d& target) {
  for (std::size_t i = 0; i < 3; ++i) axes_[i].command(time, target[static_cast<Eigen::Index>(i)]);
}

void ThreeAxes::halt(double time) {
  for (AxisMotion& axis : axes_) axis.halt(time);
}

Eigen::Vector3d ThreeAxes::reading(double time) const {
  Eigen::Vector3d result;
  for (std::size_t i = 0; i < 3; ++i) {
    const double motor = axes_[i].motor(time), step = configs_[i].resolution;
    result[static_cast<Eigen::Index>(i)] = step > 0 ? std::round(motor / step) * step : motor;
  }
  return result;
}

Eigen::Vector3d ThreeAxes::positions(double time) const {
  return {axes_[0].position(time), axes_[1].position(time), axes_[2].position(time)};
}

bool ThreeAxes::is_moving(double time) const {
  return std::ranges::any_of(axes_, [time](const AxisMotion& axis) { return axis.is_moving(time); });
}

SimulatedHead::SimulatedHead(const Camera& camera, const ClockPort& clock, double horizon)
    : link_("the head of camera " + camera.config().name, clock),
      zoom_limits_(camera.head_axes()[2].limits),
      axes_(camera.head_axes(), vector(camera.initial_head()), camera.config().head.delay, horizon) {}

CommandOutcome SimulatedHead::command(const HeadState& state) {
  if (auto fault = link_.fault()) return *fault;
  if (!vector(state).allFinite()) return link_.refusal("a position is not a finite number");
  axes_.command(link_.now(), vector(state));
  return Accepted{};
}

CommandOutcome SimulatedHead::halt() {
  if (auto fault = link_.fault()) return *fault;
  axes_.halt(link_.now());
  return Accepted{};
}

Outcome<HeadReading> SimulatedHead::read() {
  if (auto fault = link_.fault()) return *fault;
  const double now = link_.now();
  return HeadReading{now, head_state(axes_.reading(now)), axes_.is_moving(now)};
}

HeadState SimulatedHead::truth(double time) const {
  HeadState state = head_state(axes_.positions(time));
  // The play leads past the motor's limits, but the lens ends there.
  state.zoom = std::clamp(state.zoom, zoom_limits_[0], zoom_limits_[1]);
  return state;
}

SimulatedStage::SimulatedStage(const Camera& camera, const ClockPort& clock, double horizon)
    : link_("the stage of camera " + camera.config().name, clock),
      axes_(camera.stage_axes(), camera.initial_stage().offset, camera.config().mount.stage.delay, horizon) {}

CommandOutcome SimulatedStage::command(const StageState& state) {
  if (auto fault = link_.fault()) return *fault;
  if (!state.offset.allFinite()) return link_.refusal("a position is not a finite number");
  axes_.command(link_.now(), state.offset);
  return Accepted{};
}

CommandOutcome SimulatedStage::halt() {
  if (auto fault = link_.fault()) return *fault;
  axes_.halt(link_.now());
  return Accepted{};
}

Outcome<StageReading> SimulatedStage::read() {
  if (auto fault = link_.fault()) return *fault;
  const double now = link_.now();
  return StageReading{now, {axes_.reading(now)}, axes_.is_moving(now)};
}

}  // namespace flexura
