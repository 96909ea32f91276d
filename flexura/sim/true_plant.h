#pragma once

#include <memory>

#include "flexura/sim/plant.h"

namespace flexura {

/// Creates the plant of the setup's truth: a rod or a chain of arcs. Errors as theirs.
[[nodiscard]] std::unique_ptr<Plant> true_plant(const PlantSetup& setup);

}  // namespace flexura
