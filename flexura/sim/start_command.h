#pragma once

#include <Eigen/Core>

#include "flexura/sim/arm_setup.h"

namespace flexura {

/// Returns the initial command u of a plant (PlantSetup::start): the true arm's initial state, or the motor
/// positions of the model's. Both need a drive or none.
[[nodiscard]] Eigen::VectorXd start_command(const ArmSetup& model, const ArmSetup& truth);

}  // namespace flexura
