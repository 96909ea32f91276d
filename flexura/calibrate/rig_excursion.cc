#include "flexura/calibrate/rig_excursion.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

namespace flexura {

RigExcursion::RigExcursion(const RigPorts& ports, const RigModel& nominal,
                           const std::array<std::size_t, 2>& cameras, const RigPatience& patience,
                           double move_duration, RigSessionWatcher& watcher)
    : commander_(ports, nominal, patience),
      watcher_(watcher),
      cameras_(cameras),
      move_duration_(move_duration) {
  if (ports.cameras.size() != nominal.cameras.size() || cameras[0] == cameras[1] ||
      std::max(cameras[0], cameras[1]) >= ports.cameras.size())
    throw std::invalid_argument("a calibration needs the ports of two cameras of the model");
}

RigExcursion::Error RigExcursion::begin() {
  for (const std::size_t camera : cameras_)
    if (auto error = commander_.must_move(camera)) return "cannot calibrate: " + *error;
  if (auto error = commander_.settle()) return error;
  const auto arm = commander_.arm();
  if (const auto* why = std::get_if<std::string>(&arm)) return *why;
  home_ = std::get<ArmState>(arm), shown_ = home_;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto stance = commander_.stance(cameras_[i]);
    if (const auto* why = std::get_if<std::string>(&stance)) return *why;
    start_[i] = std::get<RigStance>(stance);
  }
  stands_ = start_;
  has_begun_ = true;
  return std::nullopt;
}

RigExcursion::Error RigExcursion::show(const ArmState& pose) {
  if (pose == shown_) return std::nullopt;
  if (home_ != shown_)
    if (auto error = bend(home_)) return error;
  return home_ == pose ? std::nullopt : bend(pose);
}

RigExcursion::Error RigExcursion::bend(const ArmState& state) {
  watcher_.arm_sent(commander_.now(), state, move_duration_);
  if (auto error = commander_.bend(state, move_duration_)) return error;
  shown_ = state;
  return commander_.settle();
}

RigExcursion::Error RigExcursion::send(std::size_t i, const RigStance& stance) {
  watcher_.camera_sent(commander_.now(), stance);
  stands_[i] = stance;
  return commander_.go(stance);
}

std::variant<CameraObservation, std::string> RigExcursion::picture(std::size_t i, std::size_t look) const {
  const auto taken = commander_.frame(cameras_[i], commander_.now());
  if (const auto* why = std::get_if<std::string>(&taken)) return *why;
  const auto stance = commander_.stance(cameras_[i]);
  if (const auto* why = std::get_if<std::string>(&stance)) return *why;
  return CameraObservation{.look = look,
                           .stance = std::get<RigStance>(stance),
                           .pose = {},
                           .frame = std::get<Frame>(taken),
                           .seen = {},
                           .values = {},
                           .circle = {}};
}

std::string RigExcursion::retreat() {
  if (!has_begun_) return "; nothing was moved";
  Error error;
  const auto keep = [&error](Error another) {
    if (!error) error = std::move(another);
  };
  for (const RigStance& stance : start_) {
    watcher_.camera_sent(commander_.now(), stance);
    keep(commander_.go(stance));
  }
  watcher_.arm_sent(commander_.now(), home_, move_duration_);
  keep(commander_.bend(home_, move_duration_));
  keep(commander_.settle());
  if (error) return "; error on the way back: " + *error;
  return "; heads, stages and arm have returned to the start";
}

}  // namespace flexura
