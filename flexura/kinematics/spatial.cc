#include "flexura/kinematics/spatial.h"

#include <stdexcept>
#include <string>

namespace flexura {
namespace {

Pose section_pose(const Arm& arm, const ArmState& state, std::size_t i) {
  return arc_pose(state.bends[i], arm.sections[i].length * state.stretches[i]);
}

}  // namespace

void section_frames(const Arm& arm, const ArmState& state, std::span<Pose> frames) {
  require_fit(arm, state);
  if (frames.size() != arm.sections.size() + 1) {
    throw std::invalid_argument(std::to_string(arm.sections.size()) + " sections have one frame more, not " +
                                std::to_string(frames.size()));
  }
  frames[0] = arm.X_WB;
  for (std::size_t i = 0; i < arm.sections.size(); ++i)
    frames[i + 1] = frames[i] * section_pose(arm, state, i);
}

Pose tip_pose(const Arm& arm, const ArmState& state) {
  require_fit(arm, state);
  Pose X_WT = arm.X_WB;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) X_WT = X_WT * section_pose(arm, state, i);
  return X_WT;
}

MaterialPoint material_point(const Arm& arm, double s) {
  const double length = arm.length();
  const double tolerance = 1e-12 * length;
  const bool inside = s >= -tolerance && s <= length + tolerance;
  if (!inside) {
    throw std::out_of_range("arc length " + std::to_string(s) + " is outside [0, " + std::to_string(length) +
                            "]");
  }
  if (s <= 0.0) return {0, 0.0};
  double start = 0.0;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const double end = start + arm.sections[i].length;
    if (s <= end) return {i, s == end ? 1.0 : (s - start) / arm.sections[i].length};
    start = end;
  }
  return {arm.sections.size() - 1, 1.0};
}

double arc_length_of(const Arm& arm, const ArmState& state, const MaterialPoint& point) {
  require_fit(arm, state);
  double s = 0.0;
  for (std::size_t i = 0; i < point.section; ++i) s += arm.sections[i].length * state.stretches[i];
  return s + point.fraction * (arm.sections[point.section].length * state.stretches[point.section]);
}

}  // namespace flexura
