#include "flexura/servo/servo_sights.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <utility>

#include "flexura/kinematics/plus_way.h"

namespace flexura {

ServoSights::ServoSights(ServoRig& rig, const RigModel& believed, const ServoConfig& config,
                         ServoWatcher& watcher)
    : rig_(rig),
      model_(believed),
      config_(config),
      watcher_(watcher),
      eyes_(believed, config.cameras, config.markers, config.camera_doubt) {}

void ServoSights::begin(double time) { start_ = seen_since_ = time; }

bool ServoSights::look(double now, const ServoGoals& goals) {
  if (!rig_.look()) {
    std::string why;
    for (std::size_t i = 0; i < 2 && why.empty(); ++i)
      if (!rig_.silence()[i].empty()) why = fmt::format("camera {}: {}", rig_.name(i), rig_.silence()[i]);
    if (why.empty() && blind_for(now) > config_.patience.blind) why = no_pictures();
    if (!why.empty()) tell_unseen(now, why);
    return false;
  }
  const auto& frames = rig_.frames();
  const double time = 0.5 * (frames[0].time + frames[1].time);
  const std::array<View, 2> views = {rig_.view(0, frames[0].time), rig_.view(1, frames[1].time)};
  ServoSight sight = eyes_.look(frames, views, expected(rig_.believed(time)));
  WantedShape wanted = goals.at(time - start_);
  sight.desired = std::move(wanted.state), sight.desired_offset = std::move(wanted.offset);
  watcher_.seen(sight);
  if (!first_) first_ = sight;
  if (!sight.estimate.is_found) {
    tell_unseen(now, no_shape(sight));
    return false;
  }
  if (!unseen_because_.empty() && last_) watcher_.told(now, "the arm is seen again");
  unseen_because_.clear();
  seen_since_ = now;
  last_ = std::move(sight);
  return true;
}

std::string ServoSights::unseen_because() const {
  return unseen_because_.empty() ? no_pictures() : unseen_because_;
}

ArmState ServoSights::expected(ArmState state) const {
  return last_ ? plus_way(std::move(state), rig_.believed(last_->time), last_->estimate.shape.state) : state;
}

double ServoSights::sigma_of(const ShapeEstimate& estimate) const {
  const double common = config_.camera_doubt.is_any() ? 1 : estimate.scale;
  return estimate.rms_sigma() / (common * model_.arm.length());
}

// Whose pictures do not come.
std::string ServoSights::no_pictures() const {
  std::string whose;
  for (std::size_t i = 0; i < 2; ++i)
    if (!(rig_.newest(i) > seen_since_)) whose += (whose.empty() ? "camera " : " and ") + rig_.name(i);
  return whose.empty() ? "no pictures come that belong together" : "no pictures come of " + whose;
}

// Why pictures tell none.
std::string ServoSights::no_shape(const ServoSight& sight) const {
  for (std::size_t i = 0; i < 2; ++i)
    if (!sight.reasons[i].empty())
      return fmt::format("camera {} does not see the arm: {}", rig_.name(i), sight.reasons[i]);
  return rig_.by_name(sight.estimate.reason);
}

void ServoSights::tell_unseen(double now, const std::string& why) {
  if (unseen_because_.empty()) watcher_.told(now, why);
  unseen_because_ = why;
}

}  // namespace flexura
