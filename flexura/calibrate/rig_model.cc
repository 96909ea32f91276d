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
  for (const CameraConfig& camera : cameras) model.cameras.push_back({.config = camera});
  return model;
}

View view_of(const RigModel& model, const RigStance& stance) {
  const RigCamera& camera = model.cameras.at(stance.camera);
  HeadState head = stance.head;
  head.pan += camera.pan_zero, head.tilt += camera.tilt_zero;
  return Camera(camera.config).view(stance.stage, head);
}

RigPrior rough_prior(const RigModel& model, double share) {
  RigPrior prior;
  for (const RigCamera& camera : model.cameras) {
    const Eigen::Vector3d way = vector(camera.config.mount.position) - model.arm.X_WB.position;
    prior.cameras.emplace_back().position = share * way.norm();
  }
  return prior;
}

}  // namespace flexura
