#include "flexura/calibrate/rig_model.h"

#include "flexura/camera/camera.h"
#include "flexura/math/arrays.h"

namespace flexura {

ArmState RigModel::bent(const ArmState& state) const {
  ArmState result = state;
  for (std::size_t i = 0; i < bend_gains.size(); ++i) result.bends.at(i) *= bend_gains[i];
  return result;
}

RigModel rig_model(const Arm& arm, const std::vector<CameraConfig>& cameras) {
  RigModel model;
  model.arm = arm;
  model.bend_gains.assign(arm.sections.size(), 1.0);
  model.cameras = cameras;
  return model;
}

View view_of(const RigModel& model, const RigStance& stance) {
  return Camera(model.cameras.at(stance.camera)).view(stance.stage, stance.head);
}

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
