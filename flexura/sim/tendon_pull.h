#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/model/arm.h"
#include "flexura/sim/arm_setup.h"

// Tendons of a rod that are pulled in one by one: how far, and what arcs would make of that.
namespace flexura {

/// The bends, and the stretch of sections whose limits let them stretch, of which arc_displacements() come
/// nearest to these, by least squares; of what they determine not at all, or a hundred times less well than
/// the rest, the least step from straight. It is drawn to no limits. std::invalid_argument: not one finite
/// displacement a tendon.
[[nodiscard]] ArmState nearest_arcs(const Rod& rod, const Arm& arm, const std::vector<double>& displacements);

/// A tendon that can be pulled in by itself.
struct PulledTendon {
  std::size_t section = 0;  ///< At whose end it is fastened, 0 at the base.
  /// How far, m: what bends within the sections' limits ask of it (a section without a limit bends by a whole
  /// turn), as far as its motor turns.
  std::array<double, 2> range = {0, 0};
  /// How far each tendon goes for a metre of this one so that none pulls against it: 1 of itself. Of arcs
  /// that bend the section where it ends, from straight.
  std::vector<double> together;
  /// Where it runs, from the base to its end: arc length of the rod at rest, and offset in the cross-section,
  /// m.
  std::vector<std::array<double, 3>> route;
};

/// Those of a rod; none of another arm.
[[nodiscard]] std::vector<PulledTendon> pulled_tendons(const ArmSetup& setup);

/// Whether anything pulls at a rod beside its tendons.
[[nodiscard]] bool has_loads(const RodLoads& loads);

}  // namespace flexura
