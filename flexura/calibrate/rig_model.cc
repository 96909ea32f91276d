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
  return Camera(model.cameras.at(stance.camera)).view({stance.head, stance.stage});
}

LensConfig spelled_out(const CameraConfig& camera) {
  const ZoomTable table(camera.lens, camera.sensor.width, camera.sensor.height);
  LensConfig lens = camera.lens;
  lens.fy = lens.fy.value_or(lens.fx);
  lens.cx = lens.cx.value_or(0.5 * static_cast<double>(camera.sensor.width - 1));
  lens.cy = lens.cy.value_or(0.5 * static_cast<double>(camera.sensor.height - 1));
  for (ZoomRow& row : lens.zoom) {
    const Intrinsics there = table.at(row.count.value_or(row.ratio));
    row.fx = there.fx, row.fy = there.fy, row.cx = there.cx, row.cy = there.cy;
    row.distortion = there.distortion;
  }
  return lens;
}

CameraConfig with_principal_point_moved(CameraConfig camera, const Eigen::Vector2d& by) {
  camera.lens = spelled_out(camera);
  *camera.lens.cx += by.x(), *camera.lens.cy += by.y();
  for (ZoomRow& row : camera.lens.zoom) *row.cx += by.x(), *row.cy += by.y();
  return camera;
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
