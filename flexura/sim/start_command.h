#pragma once

#include <Eigen/Core>

#include "flexura/sim/arm_setup.h"

namespace flexura {

/// Returns the initial command u of a plant (PlantSetup::start). Without drives, u is the initial state of
/// the true arm. With drives, u has the motor positions for the model's initial state. Either both arms or
/// neither arm must have a drive.
[[nodiscard]] Eigen::VectorXd start_command(const ArmSetup& model, const ArmSetup& truth);

}  // namespace flexura
