#include "flexura/calibrate/rig_prior.h"

#include "flexura/math/arrays.h"

namespace flexura {

RigPrior rough_prior(const RigModel& model, double share, const std::optional<Eigen::Vector3d>& seen) {
  RigPrior prior;
  for (const CameraConfig& camera : model.cameras) {
    const Eigen::Vector3d way = vector(camera.mount.position) - seen.value_or(model.arm.X_WB.position);
    CameraPrior& rough = prior.cameras.emplace_back();
    rough.position = share * way.norm();
    if (camera.mount.stage.can_move()) rough.pan_zero = rough.tilt_zero;
  }
  return prior;
}

}  // namespace flexura
