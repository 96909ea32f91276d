#pragma once

#include "flexura/kinematics/inverse.h"

namespace flexura {

/// Throws std::invalid_argument for an invalid target or configuration of inverse kinematics (inverse.h).
void check_question(const TipTarget& target, const InverseConfig& config);
void check_question(const CurveTarget& target, const InverseConfig& config);

}  // namespace flexura
