#pragma once

namespace flexura {

/// Energies of a rod in motion, J.
struct RodEnergy {
  double kinetic = 0, strain = 0;
  double gravity = 0;  ///< Of weight and of the force along the rod; 0 at the base's height.

  [[nodiscard]] double total() const { return kinetic + strain + gravity; }
};

}  // namespace flexura
