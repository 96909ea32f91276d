#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/mechanics/identification.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

// From measured places along a rod to its strain modes: what a laboratory has, made to what identification
// takes (docs/mechanics.md, "Identification").
namespace flexura {

/// What was measured of a rod at a time.
struct RodPlaceSample {
  double time = 0;                         ///< s, above that of the one before.
  std::vector<Eigen::Vector3d> positions;  ///< Of the places, in the frame of the rod's base, m.
  std::vector<double> tensions = {};       ///< N, one a tendon, each >= 0; empty: none pulls.
};

/// The motion of a rod's modes that measured places show.
struct RodPlaceRecord {
  RodMotionRecord record;  ///< With the modes' standard deviations; the modes' rates are not in it.
  double noise = 0;        ///< Of each coordinate of a place, m, standard deviation: as given, or as found.
  double rms = 0;          ///< What the modes leave of the coordinates, root mean square, m.
};

/// The modes that come nearest to places, at each time by least squares, under loads. Strains that places do
/// not show, such as a twist of a straight rod, stay near rest: beside the places count the energies of all
/// strains, as a prior. The energy of the bends in the record is what a mode of bending may have, and a
/// hundredth of it what a mode of another strain may. `noise`: of each coordinate, m, standard deviation; 0:
/// not known, then what the modes leave tells it, but for 1e-5 of the rod's length, which counts at least.
/// std::invalid_argument: the problems of the rod; places outside it or twice the same, numbers that are not
/// finite, fewer than two samples, another number of positions, not more coordinates than modes, or places
/// that no shape of the rod comes near to.
[[nodiscard]] RodPlaceRecord record_of_places(const Rod& rod, std::span<const RodPlace> places,
                                              std::span<const RodPlaceSample> samples, const RodLoads& loads,
                                              double noise = 0);

/// How far a rod is from the places when it moves by itself under the record's tensions, from its first
/// sample on: root mean square of the distances of all places at all times, m. Infinite: its motion cannot be
/// computed. std::invalid_argument: as record_of_places(); a record that is not of these samples; errors of
/// RodDynamics.
[[nodiscard]] double places_missed(const Rod& rod, std::span<const RodPlace> places,
                                   std::span<const RodPlaceSample> samples, const RodPlaceRecord& record);

}  // namespace flexura
