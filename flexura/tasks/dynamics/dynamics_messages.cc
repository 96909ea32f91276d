#include "flexura/tasks/dynamics/dynamics_messages.h"

#include "flexura/base/table.h"

namespace flexura {

const Table<DynamicsSampleMessage>& fields_of(const DynamicsSampleMessage*) {
  using M = DynamicsSampleMessage;
  static const auto table =
      Table<M>("flexura.DynamicsSample", "State and energies of a distributed arm at one time.")
          .field("time", &M::time, {.meaning = "Time since the experiment's start, s."})
          .field("kinetic_energy", &M::kinetic_energy, {.meaning = "T, J."})
          .field("gravity_energy", &M::gravity_energy,
                 {.meaning = "Potential energy of gravity V_g, J; 0 for an arm with all its mass at the "
                             "height of the base."})
          .field("elastic_energy", &M::elastic_energy, {.meaning = "V_e, J."})
          .field("potential", &M::potential,
                 {.meaning = "Pi, J; it includes V_e if `law.elasticity` is `shaped`."})
          .field("lyapunov", &M::lyapunov, {.meaning = "Lyapunov function W = T + Pi, J."})
          .field("taken_by_law", &M::taken_by_law,
                 {.meaning = "Energy removed by the law's damping since the task's start, J."})
          .field("taken_by_medium", &M::taken_by_medium,
                 {.meaning = "Energy removed by the arm's own damping since the task's start, J."})
          .field("azimuth_error", &M::azimuth_error,
                 {.meaning = "Error of theta, root mean square along the arm, rad."})
          .field("elevation_error", &M::elevation_error,
                 {.meaning = "Error of q, root mean square along the arm, rad."})
          .field("spatial_error", &M::spatial_error,
                 {.meaning = "Root mean square of cos q times the error of theta, and the error of q, along "
                             "the arm, rad."})
          .field("tip_error", &M::tip_error, {.meaning = "Distance of the tip from its target, m."})
          .field("s", &M::s, {.meaning = "Positions along the arm at rest, from base to tip, m."})
          .field("azimuths", &M::azimuths, {.meaning = "theta at these positions, rad, from +Y towards +X."})
          .field("elevations", &M::elevations,
                 {.meaning = "q at these positions, rad, from the plane XOY towards +Z."})
          .field("points", &M::points,
                 {.meaning = "Points of the base, of the arm at these positions, and of the tip, in the "
                             "world frame, m."});
  return table;
}

}  // namespace flexura
