#include "flexura/model/arm.h"

namespace flexura {

Pose default_base_pose() {
  Pose X_WB;
  X_WB.rotation.col(0) = Eigen::Vector3d::UnitX();
  X_WB.rotation.col(1) = -Eigen::Vector3d::UnitZ();
  X_WB.rotation.col(2) = Eigen::Vector3d::UnitY();
  return X_WB;
}

double Arm::length() const {
  double sum = 0.0;
  for (const Section& section : sections) sum += section.length;
  return sum;
}

}  // namespace flexura
