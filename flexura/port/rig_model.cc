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
  if (actuation.is_identity()) return ArmModel(arm);
  return {driven, actuation.with_gains(bend_gains), arm};
}

RigModel rig_model(const ArmModel& arm, const std::vector<CameraConfig>& cameras) {
  RigModel model;
  model.arm = arm.shaped();
  if (!arm.actuation().is_identity()) model.driven = arm.driven(), model.actuation = arm.actuation();
  model.bend_gains.assign(arm.actuation().arcs(), 1.0);
  model.cameras = cameras;
  return model;
}

View view_of(const RigModel& model, const RigStance& stance) {
  return Camera(model.cameras.at(stance.camera)).view(stance.stance());
}

}  // namespace flexura
