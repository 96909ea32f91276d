#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

NodePull& NodePull::operator+=(const NodePull& other) {
  if (other.is_idle) return *this;
  if (is_idle) return *this = other;
  if (is_held || other.is_held) {
    const auto hold = [](const NodePull& pull, const Matrix6d& held, const Matrix6d& exact) -> Matrix6d {
      return pull.is_held ? held : Matrix6d(-exact);
    };
    stiffness = hold(*this, stiffness, by_pose) + hold(other, other.stiffness, other.by_pose);
    damping = hold(*this, damping, by_twist) + hold(other, other.damping, other.by_twist);
    is_held = true;
  }
  is_coupled = is_coupled || other.is_coupled;
  wrench += other.wrench;
  by_pose += other.by_pose;
  by_twist += other.by_twist;
  return *this;
}

}  // namespace flexura
