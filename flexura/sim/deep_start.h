#pragma once

#include <cstddef>
#include <optional>

#include "flexura/sim/rig_config.h"

namespace flexura {

/// A point of an arm that would start so deep in an obstacle that contact cannot push the arm out.
struct DeepStart {
  std::size_t obstacle = 0;  ///< Index of the obstacle in the truth's RigConfig::obstacles.
  double s_rest = 0;         ///< Deepest point of the arm: arc length from the base at rest, m.
  double depth = 0;          ///< Depth of the arm's surface at this point, m.
};

/// Returns the deepest point of the true arm's centerline inside an obstacle when a simulation starts.
/// Contact pushes towards the nearest side of the obstacle, so it may push such an arm further in
/// (docs/mechanics.md, "Contact"). Returns std::nullopt if there is no such point or no initial equilibrium,
/// or if the true arm has no inertia or no contact. `model` and `truth` are as for SimulatedRig. Throws
/// std::invalid_argument if `model` or `truth` has an invalid arm.
[[nodiscard]] std::optional<DeepStart> deep_start(const RigConfig& model, const RigConfig& truth);

}  // namespace flexura
