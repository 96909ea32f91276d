#include "flexura/safety/singular.h"

#include <algorithm>
#include <vector>

#include "flexura/kinematics/jacobian.h"
#include "flexura/math/dense.h"

namespace flexura {

TipFreedom tip_freedom(const Arm& arm, const ArmState& state) {
  const Jacobian whole = tip_jacobian(arm, state);
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const auto first = static_cast<Eigen::Index>(3 * i);
    free.push_back(first);
    if (arm.kind == ArmKind::spatial) free.push_back(first + 1);
    if (arm.sections[i].can_stretch()) free.push_back(first + 2);
  }
  const Eigen::MatrixXd velocities = whole.topRows<3>()(Eigen::all, free);
  const Eigen::VectorXd speeds = singular_values(velocities);
  const auto rank = (speeds.array() > 1e-9 * speeds.maxCoeff()).count();
  const std::size_t dimensions = arm.kind == ArmKind::planar ? 2 : 3;
  // One spatial section without stretch reaches a surface only.
  return {static_cast<std::size_t>(rank), std::min(dimensions, free.size())};
}

}  // namespace flexura
