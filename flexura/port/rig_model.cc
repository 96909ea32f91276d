#include "flexura/port/rig_model.h"

namespace flexura {

std::size_t RigModel::sections() const {
  return driven.sections.empty() ? arm.sections.size() : driven.sections.size();
}

ArmState RigModel::bent(const ArmState& command) const {
  ArmState result = actuation.shape(command);
  for (std::size_t i = 0; i < bend_gains.size(); ++i) result.bends.at(i) *= bend_gains[i];
  return result;
}

ArmModel RigModel::arm_model() const {
  if (actuation.is_one_to_one()) return ArmModel(arm);
  return {driven, actuation.with_gains(bend_gains), arm};
}

RigModel rig_model(const Arm& driven, const std::vector<CameraConfig>& cameras) {
  RigModel model;
  const Actuation actuation(driven);
  model.arm = shaped_arm(driven, actuation);
  if (!actuation.is_one_to_one()) model.driven = driven, model.actuation = actuation;
  model.bend_gains.assign(actuation.arcs(), 1.0);
  model.cameras = cameras;
  return model;
}

View view_of(const RigModel& model, const RigStance& stance) {
  return Camera(model.cameras.at(stance.camera)).view(stance.stance());
}

}  // namespace flexura
