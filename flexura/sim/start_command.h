#pragma once

#include <Eigen/Core>

#include "flexura/sim/arm_setup.h"

namespace flexura {

/// Returns the initial command u of a plant (PlantSetup::start). Without drives, it is the initial state of
/// the true arm. With drives, it is the motor positions of the model's initial state. Either both arms have a
/// drive or none.
[[nodiscard]] Eigen::VectorXd start_command(const ArmSetup& model, const ArmSetup& truth);

}  // namespace flexura
