#pragma once

#include <memory>

#include "flexura/sim/plant.h"

namespace flexura {

/// Creates the plant of the setup's truth, which is a DynamicPlant, a StaticPlant or an ArcPlant. Throws the
/// exceptions of these classes.
[[nodiscard]] std::unique_ptr<Plant> true_plant(const PlantSetup& setup);

}  // namespace flexura
