#include "flexura/tasks/dynamics/dynamics_messages.h"

#include "flexura/base/table.h"

namespace flexura {

const Table<DynamicsSampleMessage>& fields_of(const DynamicsSampleMessage*) {
  using M = DynamicsSampleMessage;
  static const auto table =
      Table<M>("flexura.DynamicsSample", "A distributed arm at one time, and its energies.")
          .field("time", &M::time, {.meaning = "Time since the experiment's start, s."})
          .field("kinetic_energy", &M::kinetic_energy, {.meaning = "T, J."})
          .field("gravity_energy", &M::gravity_energy,
                 {.meaning = "V_g, J; 0 with all of the mass at the base."})
          .field("elastic_energy", &M::elastic_energy, {.meaning = "V_e, J."})
          .field("potential", &M::potential,
                 {.meaning = "Pi, J; where elasticity is shaped V_e is part of it."})
          .field("lyapunov", &M::lyapunov, {.meaning = "Lyapunov's function W = T + Pi, J."})
          .field("taken_by_law", &M::taken_by_law,
                 {.meaning = "What the law's damping took since the task's start, J."})
          .field("taken_by_medium", &M::taken_by_medium, {.meaning = "What the arm's own took, J."})
          .field("azimuth_error", &M::azimuth_error,
                 {.meaning = "theta less that of the target, root mean square along the arm, rad."})
          .field("elevation_error", &M::elevation_error,
                 {.meaning = "q less that of the target, root mean square along the arm, rad."})
          .field("spatial_error", &M::spatial_error,
                 {.meaning = "Both together: of cos q times theta's and of q's, rad."})
          .field("tip_error", &M::tip_error, {.meaning = "The tip's distance from that of the target, m."})
          .field("s", &M::s, {.meaning = "Places along the arm at rest, base to tip, m."})
          .field("azimuths", &M::azimuths, {.meaning = "theta there, rad from +Y towards +X."})
          .field("elevations", &M::elevations, {.meaning = "q there, rad from the plane XOY towards +Z."})
          .field("points", &M::points,
                 {.meaning = "The base, the arm at these places, and the tip, in the world, m."});
  return table;
}

}  // namespace flexura
