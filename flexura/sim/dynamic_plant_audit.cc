// Whether the energy of a moving arm grows without a cause.
#include <cstddef>

#include "flexura/sim/dynamic_plant.h"

namespace flexura {

// Returns whether anything but inner forces and the weight may supply energy between these times.
bool DynamicPlant::is_driven(const Snapshot& at, double from, double to) const {
  return drag_ || grabbed_ || at.carried != snapshots_.back().carried || !inputs().loads(to).ends.empty() ||
         !events(from, to).empty() || inputs().is_weighed_anew(from, to) ||
         inputs().rest_stretches(from) != inputs().rest_stretches(to) ||
         inputs().displacements(from, at.rotors.behind) != inputs().displacements(to, at.rotors.behind) ||
         at.rotors.behind != snapshots_.back().rotors.behind ||
         (contact_ && !contact_->find(dynamics_.point_motions(at.state)).empty());
}

// Checks every few steps, because the energy costs a part of a step.
void DynamicPlant::audit(Snapshot& at, double from, double to) const {
  constexpr long interval = 4;
  if (is_driven(at, from, to)) {
    at.audit.restart();
    return;
  }
  if (at.index % interval != 0) return;
  set_lengths(to);
  const RodEnergy energy = dynamics_.energy(at.state, inputs().loads(to));
  double tendons = 0;
  for (std::size_t i = 0; i < at.state.tensions.size(); ++i)
    tendons += 0.5 * inputs().rod().tendons[i].compliance * at.state.tensions[i] * at.state.tensions[i];
  at.audit.add(energy.total() + tendons, energy.kinetic + energy.strain + tendons);
}

}  // namespace flexura
