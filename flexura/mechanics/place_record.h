#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/mechanics/identification.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

// Strain modes from places measured along a rod, as input of the identification (docs/mechanics.md,
// "Identification").
namespace flexura {

/// Measurement of a rod's places at one time.
struct RodPlaceSample {
  double time = 0;                         ///< Time, s; later than in the previous sample.
  std::vector<Eigen::Vector3d> positions;  ///< Measured places, in the frame of the rod's base, m.
  std::vector<double> tensions = {};       ///< Tensions, N, one per tendon, each >= 0; empty: zero.
};

/// Motion of a rod's modes from measured places.
struct RodPlaceRecord {
  RodMotionRecord record;  ///< Modes with their standard deviations, without rates.
  double noise = 0;        ///< Standard deviation of each coordinate of a place, m, given or estimated.
  double rms = 0;          ///< Root mean square residual of the coordinates, m.
};

/// Fits the modes to places at each time by least squares, under loads. The strain energies of the modes are
/// the prior of the fit. So strains that do not affect the places, such as the twist of a straight rod,
/// remain near their undeformed values. The prior energy of a bending mode is computed from the bends in the
/// record. The prior energy of any other mode is a hundredth of this energy. `noise`: standard deviation of
/// each coordinate, m. If `noise` is 0, the noise is estimated from the residuals, with a lower bound of 1e-5
/// of the rod's length. Throws std::invalid_argument for an invalid rod, numbers that are not finite, fewer
/// than two samples, or wrong numbers of positions. The exception is also thrown for duplicate places, for
/// places outside the rod, and for positions far from all shapes of the rod. The number of coordinates must
/// be larger than the number of modes. `progress`, if any, is called during the fits.
[[nodiscard]] RodPlaceRecord record_of_places(const Rod& rod, std::span<const RodPlace> places,
                                              std::span<const RodPlaceSample> samples, const RodLoads& loads,
                                              double noise = 0, Progress* progress = nullptr);

/// Simulates the rod under the record's tensions from its first sample on. Returns the root mean square
/// distance of all places at all times, m; infinity if the motion cannot be computed. Throws the exceptions
/// of record_of_places() and RodDynamics, and std::invalid_argument if the record does not belong to these
/// samples. `progress`, if any, is called during the simulation.
[[nodiscard]] double places_missed(const Rod& rod, std::span<const RodPlace> places,
                                   std::span<const RodPlaceSample> samples, const RodPlaceRecord& record,
                                   Progress* progress = nullptr);

}  // namespace flexura
