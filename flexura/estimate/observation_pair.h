#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"

namespace flexura {

/// Two observations by their indices, ascending.
using ObservationPair = std::array<std::size_t, 2>;

/// Returns the two observations with the most perpendicular lines of sight and the largest visible arm, which
/// determine positions best. Needs at least two observations.
[[nodiscard]] ObservationPair best_pair(std::span<const Observation> observations);

/// Returns the points where two observations see the arm, in W, m, in the order of `one`.
[[nodiscard]] std::vector<Eigen::Vector3d> places_seen(const Observation& one, const Observation& other);

/// Returns all observations in a common order. The second of the pair keeps its order or, with `against`, is
/// reversed. The others follow the order of the points that the pair then determines. With `from_base` each
/// starts at the base, as far as its pixel shows that, and those that show an end of the arm there stay.
/// Otherwise the first of all stays unchanged, and all are reversed if necessary.
[[nodiscard]] std::vector<Observation> run_alike(std::vector<Observation> observations,
                                                 const ObservationPair& pair, bool against, bool from_base);

}  // namespace flexura
