#include "flexura/kinematics/arm_variables.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flexura {

ArmVariables::ArmVariables(const Arm& arm) {
  if (arm.sections.empty()) throw std::invalid_argument("an arm needs at least one section");
  for (const Section& section : arm.sections) {
    const bool is_spatial = arm.kind == ArmKind::spatial;
    const bool is_stretchable = section.can_stretch();
    const Part& part = parts_.emplace_back(
        Part{section.length, section.max_bend, section.stretch_limits, size_, is_spatial, is_stretchable});
    size_ = part.stretch_at() + (is_stretchable ? 1 : 0);
    if (std::isfinite(part.max_bend)) {
      bounds_.push_back(is_spatial ? Bound::disk(part.at, part.max_bend)
                                   : Bound::interval(part.at, -part.max_bend, part.max_bend));
    }
    if (is_stretchable) {
      bounds_.push_back(Bound::interval(part.stretch_at(), part.stretch_limits[0], part.stretch_limits[1]));
    }
  }
}

double ArmVariables::max_length() const {
  double length = 0.0;
  for (const Part& part : parts_) length += part.length * part.stretch_limits[1];
  return length;
}

Eigen::VectorXd ArmVariables::pack(const ArmState& state) const {
  Eigen::VectorXd x;
  pack(state, x);
  return x;
}

void ArmVariables::pack(const ArmState& state, Eigen::VectorXd& x) const {
  if (state.bends.size() != parts_.size() || state.stretches.size() != parts_.size()) {
    throw std::invalid_argument("a state for inverse kinematics needs one bend and one stretch per section");
  }
  x.resize(size_);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    x[parts_[i].at] = state.bends[i].x();
    if (parts_[i].is_spatial) x[parts_[i].at + 1] = state.bends[i].y();
    if (parts_[i].is_stretchable) x[parts_[i].stretch_at()] = state.stretches[i];
  }
  if (!x.allFinite()) throw std::invalid_argument("a state for inverse kinematics must be finite");
  project(bounds_, x);
}

ArmState ArmVariables::state(const Eigen::VectorXd& x) const {
  ArmState result;
  state(x, result);
  return result;
}

void ArmVariables::state(const Eigen::VectorXd& x, ArmState& state) const {
  state.bends.resize(parts_.size());
  state.stretches.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    state.bends[i] = parts_[i].bend(x);
    state.stretches[i] = parts_[i].stretch(x);
  }
}

}  // namespace flexura
