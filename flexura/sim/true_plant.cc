#include "flexura/sim/true_plant.h"

#include "flexura/sim/arm_setup.h"
#include "flexura/sim/dynamic_plant.h"
#include "flexura/sim/static_plant.h"

namespace flexura {

std::unique_ptr<Plant> true_plant(const PlantSetup& setup) {
  if (setup.truth.rod && setup.truth.rod->time_step) return std::make_unique<DynamicPlant>(setup);
  if (setup.truth.rod) return std::make_unique<StaticPlant>(setup);
  return arc_plant(setup);
}

}  // namespace flexura
