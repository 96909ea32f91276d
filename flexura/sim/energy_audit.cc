#include "flexura/sim/energy_audit.h"

#include <algorithm>

namespace flexura {

void EnergyAudit::add(double total, double moving) {
  // Errors of energy in steps that resolve the motion are some percent of its changes.
  constexpr double much = 0.3, rounding = 1e-9;  // Share, J.
  if (!least_) least_ = total, scale_ = 0;
  least_ = std::min(*least_, total);
  scale_ = std::max(scale_, moving);
  has_grown_ = has_grown_ || total - *least_ > much * scale_ + rounding;
}

}  // namespace flexura
