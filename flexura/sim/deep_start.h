#pragma once

#include <cstddef>
#include <optional>

#include "flexura/sim/rig_config.h"

namespace flexura {

/// Where an arm in motion would start so deep in an obstacle that contact cannot push it out.
struct DeepStart {
  std::size_t obstacle = 0;  ///< Index in RigConfig::obstacles of the truth.
  double s_rest = 0;         ///< Its deepest place on the arm: arc length from the base at rest, m.
  double depth = 0;          ///< Depth of the arm's surface there, m.
};

/// Returns the deepest place of the true arm's rest at the start of a simulation with its centerline inside
/// an obstacle. A contact pushes from the nearest side of the obstacle, so it may push such an arm further in
/// (docs/mechanics.md, "Contact"). std::nullopt: there is no such place, or the true arm is no rod in motion
/// with contact, or has no rest. `model` and `truth` as for SimulatedRig. Throws std::invalid_argument if
/// they are no valid arm.
[[nodiscard]] std::optional<DeepStart> deep_start(const RigConfig& model, const RigConfig& truth);

}  // namespace flexura
