#include "flexura/calibrate/rig_commander.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "flexura/camera/sensor.h"
#include "flexura/port/camera_moves.h"
#include "flexura/port/rig_readings.h"

namespace flexura {
namespace {

// Whether an axis is at its commanded position, within a step and rounding.
bool stands(const AxisConfig& axis, double sent, double reads) {
  constexpr double rounding = 1e-6;
  return std::abs(commandable(axis, sent) - reads) <= axis.resolution + rounding;
}

}  // namespace

RigCommander::RigCommander(const RigPorts& ports, const RigModel& nominal, const RigPatience& patience)
    : ports_(ports), sections_(nominal.sections()), patience_(patience), sent_(ports.cameras.size()) {
  for (const CameraConfig& camera : nominal.cameras) cameras_.emplace_back(camera);
}

std::variant<ArmState, std::string> RigCommander::arm() const {
  auto reading = read_arm(*ports_.arm, sections_);
  if (auto* why = std::get_if<std::string>(&reading)) return std::move(*why);
  return std::get<ArmReading>(std::move(reading)).state;
}

std::variant<RigStance, std::string> RigCommander::stance(std::size_t camera) const {
  auto reading = read_camera(ports_, camera, cameras_[camera]);
  if (auto* why = std::get_if<std::string>(&reading)) return std::move(*why);
  return std::get<StanceReading>(reading).stance;
}

RigCommander::Error RigCommander::bend(const ArmState& state, double duration) {
  if (const auto fault = ports_.arm->command(state, duration).fault()) return text(*fault);
  sent_arm_ = state;
  has_bent_ = true;
  return std::nullopt;
}

RigCommander::Error RigCommander::must_move(std::size_t camera) const {
  const CameraPorts& ports = ports_.cameras[camera];
  for (const std::string& why : {missing_head(ports), missing_stage(ports, cameras_[camera])})
    if (!why.empty()) return why;
  return std::nullopt;
}

RigCommander::Error RigCommander::go(const RigStance& stance) {
  const CameraPorts& camera = ports_.cameras[stance.camera];
  const Camera& optics = cameras_[stance.camera];
  if (const auto fault = command_head(camera, optics, stance.head).fault()) return text(*fault);
  if (const auto fault = command_stage(camera, optics, stance.stage).fault()) return text(*fault);
  sent_[stance.camera] = stance;
  return std::nullopt;
}

std::variant<bool, std::string> RigCommander::is_moving() const {
  auto arm = read_arm(*ports_.arm, sections_);
  if (auto* why = std::get_if<std::string>(&arm)) return std::move(*why);
  bool is_moving = std::get<ArmReading>(arm).moving;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    auto camera = read_camera(ports_, i, cameras_[i]);
    if (auto* why = std::get_if<std::string>(&camera)) return std::move(*why);
    is_moving = is_moving || std::get<StanceReading>(camera).moving;
  }
  return is_moving;
}

RigCommander::Error RigCommander::settle() {
  const double until = now() + patience_.settle;
  for (;;) {
    const auto moving = is_moving();
    if (const auto* error = std::get_if<std::string>(&moving)) return *error;
    if (!std::get<bool>(moving)) break;
    if (now() >= until)
      return fmt::format("a device is still moving {:.4g} s after the last command", patience_.settle);
    ports_.clock->wait_until(now() + patience_.poll);
  }
  if (std::exchange(has_bent_, false) && patience_.pause > 0)
    ports_.clock->wait_until(now() + patience_.pause);
  if (auto error = arm_elsewhere()) return error;
  for (std::size_t i = 0; i < sent_.size(); ++i)
    if (auto error = camera_elsewhere(i)) return error;
  return std::nullopt;
}

RigCommander::Error RigCommander::arm_elsewhere() const {
  if (!sent_arm_) return std::nullopt;
  const auto state = arm();
  if (const auto* error = std::get_if<std::string>(&state)) return *error;
  const auto& bends = std::get<ArmState>(state).bends;
  for (std::size_t i = 0; i < bends.size(); ++i) {
    const double off = (bends[i] - sent_arm_->bends[i]).norm();
    if (off > patience_.bend)
      return fmt::format(
          "the arm does not follow: the measured bend of section {} differs by {:.3g} rad from the commanded "
          "bend",
          i + 1, off);
  }
  return std::nullopt;
}

RigCommander::Error RigCommander::camera_elsewhere(std::size_t camera) const {
  if (!sent_[camera]) return std::nullopt;
  const auto where = stance(camera);
  if (const auto* error = std::get_if<std::string>(&where)) return *error;
  const RigStance &sent = *sent_[camera], &reads = std::get<RigStance>(where);
  const Camera& optics = cameras_[camera];
  constexpr std::array<const char*, 6> names = {"pan", "tilt", "zoom", "x", "y", "z"};
  const auto places = [](const RigStance& stance) {
    const HeadState& head = stance.head;
    const Eigen::Vector3d& slid = stance.stage.offset;
    return std::array{head.pan, head.tilt, head.zoom, slid.x(), slid.y(), slid.z()};
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    const AxisConfig axis = i < 3 ? optics.head_axes()[i] : optics.stage_axes()[i - 3];
    const double to = places(sent)[i], is = places(reads)[i];
    if (!stands(axis, to, is))
      return fmt::format(
          "the {} of camera {} does not follow: {} was commanded to {:.6g}, but its measured position is "
          "{:.6g}",
          i < 3 ? "head" : "stage", name(camera), names[i], commandable(axis, to), is);
  }
  return std::nullopt;
}

std::variant<Frame, std::string> RigCommander::frame(std::size_t camera, double time) const {
  const SensorConfig& sensor = cameras_[camera].config().sensor;
  const double until = std::max(now(), time) + patience_.frame;
  for (;;) {
    const auto outcome = ports_.cameras[camera].camera->wait(until - now());
    if (const auto fault = outcome.fault()) return text(*fault);
    const std::optional<Frame>& frame = outcome.value();
    if (!frame) return fmt::format("camera {} sent no frame for {:.4g} s", name(camera), patience_.frame);
    const double start = frame->time - 0.5 * (last_row_delay(sensor) + frame->exposure);
    constexpr double rounding = 1e-9;
    if (start >= time - rounding) return *frame;
  }
}

}  // namespace flexura
