#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/model/arm.h"
#include "flexura/sim/arm_setup.h"

// Tendons of a rod that are pulled individually: their ranges, and the nearest arcs.
namespace flexura {

/// Returns the bends and stretches whose arc_displacements() are nearest to `displacements` by least squares.
/// Stretches vary only for sections whose limits allow it. Directions that the displacements do not
/// determine, or determine a hundred times less well than the rest, take the least step from straight. Limits
/// are not applied. Throws std::invalid_argument unless there is one finite displacement per tendon.
[[nodiscard]] ArmState nearest_arcs(const Rod& rod, const Arm& arm, const std::vector<double>& displacements);

/// A tendon that can be pulled individually.
struct PulledTendon {
  std::size_t section = 0;  ///< Section at whose end it is fastened, 0 at the base.
  /// Range of displacements, m: what bends within the sections' limits require, as far as the motor can turn.
  /// A section without a limit bends by a whole turn.
  std::array<double, 2> range = {0, 0};
  /// Displacement of each tendon per metre of this one so that none pulls against it; 1 for itself. Computed
  /// for arcs that bend the section where it ends, from straight.
  std::vector<double> together;
  /// Route from the base to its end: arc length of the rod at rest, and offset in the cross-section, m.
  std::vector<std::array<double, 3>> route;
};

/// Returns the tendons of a rod; empty for other arms.
[[nodiscard]] std::vector<PulledTendon> pulled_tendons(const ArmSetup& setup);

/// Returns whether a rod has loads in addition to its tendons.
[[nodiscard]] bool has_loads(const RodLoads& loads);

}  // namespace flexura
