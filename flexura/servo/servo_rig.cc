#include "flexura/servo/servo_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/kinematics/shape.h"

namespace flexura {
namespace {

bool is_finite(const ArmState& state) {
  return std::ranges::all_of(state.bends, [](const Eigen::Vector2d& bend) { return bend.allFinite(); }) &&
         std::ranges::all_of(state.stretches, [](double stretch) { return std::isfinite(stretch); });
}

bool is_finite(const HeadState& head) {
  return std::isfinite(head.pan) && std::isfinite(head.tilt) && std::isfinite(head.zoom);
}

}  // namespace

ServoRig::ServoRig(const RigPorts& ports, const RigModel& believed, const std::array<std::size_t, 2>& cameras,
                   double span, double together)
    : ports_(ports),
      model_(believed),
      cameras_(cameras),
      together_(together),
      arm_(span, &interpolate),
      stands_{MotionHistory<Stand, StandBlend>(span, &between),
              MotionHistory<Stand, StandBlend>(span, &between)} {}

ServoRig::Stand ServoRig::between(const Stand& a, const Stand& b, double share) {
  const auto mixed = [share](double from, double to) { return from + share * (to - from); };
  Stand stand;
  stand.head = {mixed(a.head.pan, b.head.pan), mixed(a.head.tilt, b.head.tilt),
                mixed(a.head.zoom, b.head.zoom)};
  stand.stage.offset = a.stage.offset + share * (b.stage.offset - a.stage.offset);
  return stand;
}

ServoRig::Trouble ServoRig::read() {
  const auto arm = ports_.arm->read();
  if (const auto fault = arm.fault()) return "the arm: " + text(*fault);
  if (!std::isfinite(arm.value().time)) return "the arm tells of no time: a number is none";
  if (!is_finite(arm.value().state) || arm.value().state.bends.size() != model_.arm.sections.size())
    return "the arm's drives tell of no shape: some of their numbers are none";
  arm_.add(arm.value().time, arm.value().state);
  for (std::size_t i = 0; i < 2; ++i) {
    const CameraPorts& camera = ports_.cameras[cameras_[i]];
    const auto head = camera.head->read();
    if (const auto fault = head.fault())
      return fmt::format("the head of camera {}: {}", name(i), text(*fault));
    const auto stage = camera.stage->read();
    if (const auto fault = stage.fault())
      return fmt::format("the stage of camera {}: {}", name(i), text(*fault));
    if (!std::isfinite(head.value().time) || !is_finite(head.value().state) ||
        !stage.value().state.offset.allFinite())
      return fmt::format("camera {} does not tell how it stands: some of its numbers are none", name(i));
    stands_[i].add(head.value().time, {head.value().state, stage.value().state});
  }
  return std::nullopt;
}

bool ServoRig::look() {
  constexpr std::size_t kept = 64;  // Of each camera: one may be seconds later than the other.
  for (std::size_t i = 0; i < 2; ++i) {
    const auto frame = ports_.cameras[cameras_[i]].camera->newest();
    silence_[i] = frame.fault() ? text(*frame.fault()) : "";
    if (frame.fault() || !frame.value()) continue;
    if (!std::isfinite(frame.value()->time) || !std::isfinite(frame.value()->received)) {
      silence_[i] = "its picture tells of no time: a number is none";
      continue;
    }
    recent_[i].push_back(*frame.value());
    if (recent_[i].size() > kept) recent_[i].pop_front();
  }
  // The newest of the second camera for which the first one has one of its own, the nearest in time.
  for (auto second = recent_[1].rbegin(); second != recent_[1].rend(); ++second) {
    if (!(second->time > paired_at_[1])) return false;
    const Frame* nearest = nullptr;
    for (const Frame& first : recent_[0]) {
      const double apart = std::abs(first.time - second->time);
      if (first.time > paired_at_[0] && apart <= together_ &&
          (nearest == nullptr || apart < std::abs(nearest->time - second->time)))
        nearest = &first;
    }
    if (nearest == nullptr || nearest->time < arm_.since()) continue;
    pair_ = {*nearest, *second}, paired_at_ = {nearest->time, second->time};
    return true;
  }
  return false;
}

RigStance ServoRig::stance(std::size_t i, double time) const {
  const Stand stand = *stands_[i].at(time);
  return {.camera = cameras_[i], .head = stand.head, .stage = stand.stage};
}

View ServoRig::view(std::size_t i, double time) const { return view_of(model_, stance(i, time)); }

}  // namespace flexura
