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
/// Stretches vary only in sections whose limits allow it. The displacements may not determine some
/// combinations of bends and stretches, or may determine them a hundred times less accurately than others.
/// These combinations remain as near as possible to their values in the straight arm. Limits are not applied.
/// Throws std::invalid_argument unless there is one finite displacement per tendon.
[[nodiscard]] ArmState nearest_arcs(const Rod& rod, const Arm& arm, const std::vector<double>& displacements);

/// A tendon that can be pulled individually.
struct PulledTendon {
  std::size_t section = 0;  ///< Index of the section at whose end the tendon is fastened; 0 at the base.
  /// Range of displacements, m, that bends within the sections' limits require and that the motor can reach.
  /// A section without a limit is assumed to bend by up to a full turn.
  std::array<double, 2> range = {0, 0};
  /// Displacement of each tendon per metre of this tendon for which no tendon opposes the motion; 1 for this
  /// tendon. The displacements are computed for the straight arm and a bend of the section where this tendon
  /// ends.
  std::vector<double> together;
  /// Points of the route from the base to the tendon's end, m: arc length on the rod at rest, and offset (x,
  /// y) in the cross-section.
  std::vector<std::array<double, 3>> route;
};

/// Returns the tendons of an arm that is a rod; empty for other arms.
[[nodiscard]] std::vector<PulledTendon> pulled_tendons(const ArmSetup& setup);

/// Returns whether a rod has loads in addition to its tendons.
[[nodiscard]] bool has_loads(const RodLoads& loads);

}  // namespace flexura
