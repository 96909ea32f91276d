#include "flexura/calibrate/rig_observer.h"

#include <algorithm>
#include <utility>

#include "flexura/calibrate/etalon_observer.h"

namespace flexura {
void RigObserver::sent(std::size_t i, const RigStance& stance) {
  Sent& camera = cameras_[i];
  if (stance.head == camera.to.head && stance.stage == camera.to.stage) return;
  camera.is_turned |= stance.head.pan != camera.to.head.pan || stance.head.tilt != camera.to.head.tilt;
  camera.to = stance;
  camera.stance.reset();
}

void RigObserver::see(std::size_t i, const RigModel* found, CameraObservation& observed) {
  if (poses().empty() || poses().back() != observed.pose) poses().push_back(observed.pose);
  if (!look(i, *observed.frame.picture)) {
    observed.seen = unkept(view_of(model(found), observed.stance));
    return;
  }
  Sent& camera = cameras_[i];
  if (!camera.stance) {
    RigStance& stance = stances().emplace_back(observed.stance);
    if (!camera.is_turned) stance.turned_as = camera.last;
    camera.stance = camera.last = stances().size() - 1;
    camera.is_turned = false;
  }
  observed.seen = keep(*camera.stance, poses().size() - 1, found);
}

RigReading RigObserver::best_of(std::vector<RigReading>& readings) {
  return std::move(*std::ranges::max_element(readings, [](const RigReading& a, const RigReading& b) {
    if (a.found.is_found != b.found.is_found) return b.found.is_found;
    return a.explained < b.explained;
  }));
}

std::unique_ptr<RigObserver> session_observer(const RigModel& nominal, const RigPrior& prior,
                                              const RigSessionConfig& config, const Eigen::Vector3d& target) {
  if (config.etalon) return etalon_observer(nominal, prior, config);
  return arm_observer(nominal, prior, config, target);
}

}  // namespace flexura
