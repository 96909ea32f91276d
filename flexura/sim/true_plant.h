#pragma once

#include <memory>

#include "flexura/sim/plant.h"

namespace flexura {

/// The plant that the setup's truth is: a rod or a chain of arcs. Errors as theirs.
[[nodiscard]] std::unique_ptr<Plant> true_plant(const PlantSetup& setup);

}  // namespace flexura
