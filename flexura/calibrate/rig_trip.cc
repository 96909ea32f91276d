#include "flexura/calibrate/rig_trip.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

namespace flexura {

RigTrip::RigTrip(const RigPorts& ports, const RigModel& believed, const std::array<std::size_t, 2>& cameras,
                 const RigPatience& patience, double move_duration, RigSessionWatcher& watcher)
    : hands_(ports, believed, patience), watcher_(watcher), cameras_(cameras), move_duration_(move_duration) {
  if (ports.cameras.size() != believed.cameras.size() || cameras[0] == cameras[1] ||
      std::max(cameras[0], cameras[1]) >= ports.cameras.size())
    throw std::invalid_argument("a calibration needs the ports of two cameras of the model");
}

RigTrip::Trouble RigTrip::begin() {
  for (const std::size_t camera : cameras_)
    if (auto trouble = hands_.must_move(camera)) return "cannot calibrate: " + *trouble;
  if (auto trouble = hands_.settle()) return trouble;
  const auto arm = hands_.arm();
  if (const auto* why = std::get_if<std::string>(&arm)) return *why;
  home_ = std::get<ArmState>(arm), shown_ = home_;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto stance = hands_.stance(cameras_[i]);
    if (const auto* why = std::get_if<std::string>(&stance)) return *why;
    start_[i] = std::get<RigStance>(stance);
  }
  stands_ = start_;
  has_begun_ = true;
  return std::nullopt;
}

RigTrip::Trouble RigTrip::show(const ArmState& pose) {
  if (pose == shown_) return std::nullopt;
  if (home_ != shown_)
    if (auto trouble = bend(home_)) return trouble;
  return home_ == pose ? std::nullopt : bend(pose);
}

RigTrip::Trouble RigTrip::bend(const ArmState& state) {
  watcher_.arm_sent(hands_.now(), state, move_duration_);
  if (auto trouble = hands_.bend(state, move_duration_)) return trouble;
  shown_ = state;
  return hands_.settle();
}

RigTrip::Trouble RigTrip::send(std::size_t i, const RigStance& stance) {
  watcher_.camera_sent(hands_.now(), stance);
  stands_[i] = stance;
  return hands_.go(stance);
}

std::variant<RigSight, std::string> RigTrip::picture(std::size_t i, std::size_t look) const {
  const auto taken = hands_.frame(cameras_[i], hands_.now());
  if (const auto* why = std::get_if<std::string>(&taken)) return *why;
  const auto stance = hands_.stance(cameras_[i]);
  if (const auto* why = std::get_if<std::string>(&stance)) return *why;
  return RigSight{.look = look,
                  .stance = std::get<RigStance>(stance),
                  .pose = {},
                  .frame = std::get<Frame>(taken),
                  .seen = {},
                  .values = {},
                  .circle = {}};
}

std::string RigTrip::retreat() {
  if (!has_begun_) return "; nothing was moved";
  Trouble trouble;
  const auto keep = [&trouble](Trouble another) {
    if (!trouble) trouble = std::move(another);
  };
  for (const RigStance& stance : start_) {
    watcher_.camera_sent(hands_.now(), stance);
    keep(hands_.go(stance));
  }
  watcher_.arm_sent(hands_.now(), home_, move_duration_);
  keep(hands_.bend(home_, move_duration_));
  keep(hands_.settle());
  if (trouble) return "; on the way back: " + *trouble;
  return "; heads, stages and arm are back where they began";
}

}  // namespace flexura
