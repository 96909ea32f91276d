#include "flexura/equipment/v4l2_head.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "flexura/base/one_line.h"

namespace flexura {
namespace {

constexpr double second_of_arc = std::numbers::pi / (180 * 3600);

}  // namespace

V4l2Head::V4l2Head(const V4l2HeadConfig& config, std::string name, const ClockPort& clock,
                   const std::shared_ptr<V4l2Calls>& calls)
    : config_(config), name_(std::move(name)), clock_(clock), calls_(calls), device_(*calls, config.device) {
  // V4L2 counts pan positive to the camera's right.
  axes_ = {Axis{.control = V4L2_CID_PAN_ABSOLUTE, .name = "pan", .unit = -second_of_arc},
           Axis{.control = V4L2_CID_TILT_ABSOLUTE, .name = "tilt", .unit = second_of_arc},
           Axis{.control = V4L2_CID_ZOOM_ABSOLUTE, .name = "zoom", .unit = config.zoom_step, .fixed = 1}};
}

PortFault V4l2Head::lost(const std::string& what) const {
  return {FaultKind::link_lost, fmt::format("head \"{}\": {}: {}", name_, one_line(config_.device), what)};
}

PortFault V4l2Head::refused(const std::string& what) const {
  return {FaultKind::refused, fmt::format("head \"{}\": {}: {}", name_, one_line(config_.device), what)};
}

Outcome<std::unique_ptr<V4l2Head>> V4l2Head::open(const V4l2HeadConfig& config, const std::string& name,
                                                  const ClockPort& clock,
                                                  const std::shared_ptr<V4l2Calls>& calls) {
  std::unique_ptr<V4l2Head> head(new V4l2Head(config, name, clock, calls));
  if (const int problem = head->device_.problem(); problem < 0)
    return head->lost(v4l2_error(problem) + ": check the path and the cable");
  for (Axis& axis : head->axes_)
    if (auto fault = head->find(axis)) return *fault;
  if (std::ranges::none_of(head->axes_, &Axis::exists))
    return head->refused("the camera has no absolute pan, tilt or zoom: remove the head from the file");
  return head;
}

std::optional<PortFault> V4l2Head::find(Axis& axis) {
  v4l2_queryctrl query{};
  query.id = axis.control;
  if (device_.ioctl(VIDIOC_QUERYCTRL, &query) < 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0)
    return std::nullopt;
  axis.exists = true;
  axis.min = query.minimum, axis.max = query.maximum, axis.step = std::max(query.step, 1);
  return std::nullopt;
}

Outcome<std::int32_t> V4l2Head::value(const Axis& axis) {
  v4l2_control control{};
  control.id = axis.control;
  if (const int result = device_.ioctl(VIDIOC_G_CTRL, &control); result < 0)
    return lost(fmt::format("the camera's {} cannot be read: {}", axis.name, v4l2_error(result)));
  return control.value;
}

std::optional<PortFault> V4l2Head::set(Axis& axis, std::int32_t value) {
  const Outcome<std::int32_t> before = this->value(axis);
  if (!before) return before.fault();
  v4l2_control control{};
  control.id = axis.control;
  control.value = value;
  if (const int result = device_.ioctl(VIDIOC_S_CTRL, &control); result < 0)
    return lost(fmt::format("the camera refuses a {} of {}: {}", axis.name, value, v4l2_error(result)));
  axis.target = value;
  axis.nearest = std::abs(std::int64_t{before.value()} - value);
  axis.progress = clock_.now();
  return std::nullopt;
}

CommandOutcome V4l2Head::command(const HeadState& state) {
  const std::scoped_lock lock(mutex_);
  const std::array<double, 3> wanted = {state.pan, state.tilt, state.zoom};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Axis& axis = axes_[i];
    if (!std::isfinite(wanted[i])) return refused(fmt::format("a {} that is not a finite number", axis.name));
    if (!axis.exists && std::abs(wanted[i] - axis.fixed) > 1e-9)
      return refused(fmt::format("the camera has no {}: leave it at {:.6g}", axis.name, axis.fixed));
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    if (!axis.exists) continue;
    const double clamped = std::clamp(wanted[i] / axis.unit, double(axis.min), double(axis.max));
    const double steps = std::round((clamped - axis.min) / axis.step);
    const double reachable = std::min(axis.min + steps * axis.step, double(axis.max));
    if (auto fault = set(axis, static_cast<std::int32_t>(reachable))) return *fault;
  }
  return Accepted{};
}

CommandOutcome V4l2Head::halt() {
  const std::scoped_lock lock(mutex_);
  std::optional<PortFault> first;  // One axis that does not answer must not keep the others moving.
  for (Axis& axis : axes_) {
    if (!axis.exists) continue;
    const Outcome<std::int32_t> now = value(axis);
    std::optional<PortFault> fault = now ? set(axis, now.value()) : now.fault();
    if (fault && !first) first = fault;
  }
  if (first) return *first;
  return Accepted{};
}

std::optional<PortFault> V4l2Head::check(Axis& axis, std::int32_t value, bool* is_moving) {
  if (!axis.target) return std::nullopt;
  const std::int64_t distance = std::abs(std::int64_t{value} - *axis.target);
  const double now = clock_.now();
  if (distance < axis.nearest) axis.nearest = distance, axis.progress = now;
  if (distance < axis.step) return std::nullopt;
  if (now - axis.progress <= config_.patience) return *is_moving = true, std::nullopt;
  return refused(fmt::format(
      "the camera's {} is at {} although the camera accepted a command to {}: check that nothing blocks it "
      "and that the camera's firmware moves it",
      axis.name, value, *axis.target));
}

Outcome<HeadReading> V4l2Head::read() {
  const std::scoped_lock lock(mutex_);
  const double asked = clock_.now();
  HeadReading reading;
  std::array<double, 3> positions{};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    positions[i] = axis.fixed;
    if (!axis.exists) continue;
    const Outcome<std::int32_t> now = value(axis);
    if (!now) return *now.fault();
    if (auto fault = check(axis, now.value(), &reading.moving)) return *fault;
    positions[i] = now.value() * axis.unit;
  }
  reading.state = {.pan = positions[0], .tilt = positions[1], .zoom = positions[2]};
  reading.time = (asked + clock_.now()) / 2;
  return reading;
}

}  // namespace flexura
