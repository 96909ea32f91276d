#include "flexura/kinematics/spatial.h"

#include <stdexcept>
#include <string>

namespace flexura {
namespace {

Pose section_pose(const Arm& arm, const ArmState& state, std::size_t i) {
  return arc_pose(state.bends[i], arm.sections[i].length * state.stretches[i]);
}

void require_fit(const Arm& arm, const ArmState& state) {
  const std::size_t count = arm.sections.size();
  if (state.bends.size() == count && state.stretches.size() == count) return;
  throw std::invalid_argument("an arm of " + std::to_string(count) + " sections cannot take " +
                              std::to_string(state.bends.size()) + " bends and " +
                              std::to_string(state.stretches.size()) + " stretches");
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

std::vector<Pose> section_frames(const Arm& arm, const ArmState& state) {
  std::vector<Pose> frames(arm.sections.size() + 1);
  section_frames(arm, state, frames);
  return frames;
}

Pose tip_pose(const Arm& arm, const ArmState& state) {
  require_fit(arm, state);
  Pose X_WT = arm.X_WB;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) X_WT = X_WT * section_pose(arm, state, i);
  return X_WT;
}

std::vector<Pose> poses_at(const Backbone& backbone, std::span<const double> s) {
  std::vector<Pose> poses;
  poses.reserve(s.size());
  for (const double at : s) poses.push_back(backbone.pose(at));
  return poses;
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
