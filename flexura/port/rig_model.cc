#include "flexura/port/rig_model.h"

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
  return Camera(model.cameras.at(stance.camera)).view(stance.stance());
}

}  // namespace flexura
