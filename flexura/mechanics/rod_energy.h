#pragma once

namespace flexura {

/// Energies of a rod in motion, J.
struct RodEnergy {
  double kinetic = 0, strain = 0;
  double gravity = 0;  ///< Potential energy of weight and of RodLoads::per_length; 0 at the base's origin.

  [[nodiscard]] double total() const { return kinetic + strain + gravity; }
};

}  // namespace flexura
