#include "flexura/calibrate/rig_trip.h"

#include <optional>
#include <utility>
#include <variant>

namespace flexura {

RigTrip::Trouble RigTrip::begin() {
  if (auto trouble = hands_.settle()) return trouble;
  const auto arm = hands_.arm();
  if (const auto* why = std::get_if<std::string>(&arm)) return *why;
  home_ = std::get<ArmState>(arm), shown_ = home_;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto stance = hands_.stance(cameras_[i]);
    if (const auto* why = std::get_if<std::string>(&stance)) return *why;
    start_[i] = std::get<RigStance>(stance);
  }
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
