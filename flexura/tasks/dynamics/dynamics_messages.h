#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/log/messages.h"

namespace flexura {

/// flexura.DynamicsSample, on /dynamics/samples: the distributed arm at one time.
struct DynamicsSampleMessage {
  double time = 0;                                                    ///< In s.
  double kinetic_energy = 0, gravity_energy = 0, elastic_energy = 0;  ///< T, V_g, V_e, J.
  double potential = 0;                                               ///< Pi, J.
  double lyapunov = 0;                                                ///< W = T + Pi, J.
  double taken_by_law = 0, taken_by_medium = 0;   ///< Energy removed by damping since the start, J.
  double azimuth_error = 0, elevation_error = 0;  ///< Root mean square errors along the arm, rad.
  double spatial_error = 0;  ///< Combined error of both angles (docs/control.md, eq. 15), rad.
  double tip_error = 0;      ///< Distance of the tip from its target, m.
  std::vector<double> s;     ///< Positions along the arm at rest, m.
  std::vector<double> azimuths, elevations;  ///< Directions of the arm at the positions `s`, rad.
  std::vector<std::array<double, 3>>
      points;  ///< Points at the base, at the positions `s`, and at the tip, in W, m.
};

inline constexpr std::string_view dynamics_samples_topic = "/dynamics/samples";

const Table<DynamicsSampleMessage>& fields_of(const DynamicsSampleMessage*);

}  // namespace flexura
