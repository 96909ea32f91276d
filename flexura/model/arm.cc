#include "flexura/model/arm.h"

#include <fmt/format.h>

#include <stdexcept>

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

void require_fit(const Arm& arm, const ArmState& state) { require_fit(arm.sections.size(), state); }

void require_fit(std::size_t sections, const ArmState& state) {
  if (state.bends.size() == sections && state.stretches.size() == sections) return;
  throw std::invalid_argument(fmt::format("an arm of {} sections cannot take {} bends and {} stretches",
                                          sections, state.bends.size(), state.stretches.size()));
}

}  // namespace flexura
