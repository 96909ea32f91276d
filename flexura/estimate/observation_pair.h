#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"

namespace flexura {

/// Indices of two observations, in ascending order.
using ObservationPair = std::array<std::size_t, 2>;

/// Returns the two observations that determine positions best: those with the most nearly perpendicular lines
/// of sight and the largest visible arm. Requires at least two observations.
[[nodiscard]] ObservationPair best_pair(std::span<const Observation> observations);

/// Returns the points of the arm triangulated from two observations, in W, m, in the order of the points of
/// `one`.
[[nodiscard]] std::vector<Eigen::Vector3d> places_seen(const Observation& one, const Observation& other);

/// Returns all observations with their points in a common order along the arm. The second observation of the
/// pair keeps its order or, with `against`, is reversed. The other observations are ordered like the points
/// that the pair then triangulates. If `from_base` is true, the pair's order begins at the base. Other
/// observations in which the base is visible then keep their order. If `from_base` is false, the first of all
/// observations keeps its order. If the first observation was reversed, all observations are reversed again.
[[nodiscard]] std::vector<Observation> run_alike(std::vector<Observation> observations,
                                                 const ObservationPair& pair, bool against, bool from_base);

}  // namespace flexura
