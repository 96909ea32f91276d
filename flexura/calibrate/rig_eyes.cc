#include "flexura/calibrate/rig_eyes.h"

#include <algorithm>
#include <utility>

#include "flexura/calibrate/etalon_eyes.h"

namespace flexura {
void RigEyes::sent(std::size_t i, const RigStance& stance) {
  Sent& camera = cameras_[i];
  if (stance.head == camera.to.head && stance.stage == camera.to.stage) return;
  camera.is_turned |= stance.head.pan != camera.to.head.pan || stance.head.tilt != camera.to.head.tilt;
  camera.to = stance;
  camera.stance.reset();
}

void RigEyes::see(std::size_t i, const RigModel* found, RigSight& sight) {
  if (poses().empty() || poses().back() != sight.pose) poses().push_back(sight.pose);
  if (!look(i, *sight.frame.picture)) {
    sight.seen = unkept(view_of(model(found), sight.stance));
    return;
  }
  Sent& camera = cameras_[i];
  if (!camera.stance) {
    RigStance& stance = stances().emplace_back(sight.stance);
    if (!camera.is_turned) stance.turned_as = camera.last;
    camera.stance = camera.last = stances().size() - 1;
    camera.is_turned = false;
  }
  sight.seen = keep(*camera.stance, poses().size() - 1, found);
}

RigReading RigEyes::best_of(std::vector<RigReading>& readings) {
  return std::move(*std::ranges::max_element(readings, [](const RigReading& a, const RigReading& b) {
    if (a.found.is_found != b.found.is_found) return b.found.is_found;
    return a.explained < b.explained;
  }));
}

std::unique_ptr<RigEyes> session_eyes(const RigModel& believed, const RigPrior& prior,
                                      const RigSessionConfig& config, const Eigen::Vector3d& target) {
  if (config.etalon) return etalon_eyes(believed, prior, config);
  return arm_eyes(believed, prior, config, target);
}

}  // namespace flexura
