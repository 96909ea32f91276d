#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/sighting.h"

namespace flexura {

/// Two sightings by their places among all, rising.
using SightingPair = std::array<std::size_t, 2>;

/// The two whose lines of sight cross most squarely and that show the most of the arm: together they tell
/// places best. At least two sightings; of two, these.
[[nodiscard]] SightingPair best_pair(std::span<const Sighting> sightings);

/// Where two see the arm, in W, m, along it as `one` is followed.
[[nodiscard]] std::vector<Eigen::Vector3d> places_seen(const Sighting& one, const Sighting& other);

/// All followed alike: the second of the pair as it is or, `against`, from its other end; the others the way
/// of the places that the pair then tells. With `from_base` each is followed from the base on as far as its
/// pixel tells, and those that show an end of the arm there stay; otherwise the first of all stays as it is,
/// and all are turned if need be.
[[nodiscard]] std::vector<Sighting> run_alike(std::vector<Sighting> sightings, const SightingPair& pair,
                                              bool against, bool from_base);

}  // namespace flexura
