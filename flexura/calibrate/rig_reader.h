#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "flexura/calibrate/marker_vote.h"
#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_problem.h"
#include "flexura/calibrate/rig_sights.h"

namespace flexura {

/// A rig as it was found, and by what: markers that were taken for others count against it.
struct RigReading {
  std::optional<RigProblem> problem;  ///< Of what was recognised; there always is one.
  RigCalibration found;
  double things = 0;     ///< Markers and axis points that were taken for the arm's.
  double amiss = 0;      ///< Of them those that the rig does not explain, and markers of nobody.
  double explained = 0;  ///< Things, less twice those that it does not explain, and less markers of nobody.

  /// Whether it is found, and no more than a twentieth is amiss.
  [[nodiscard]] bool is_whole() const { return found.is_found && amiss <= 0.05 * things; }
};

/// Finds the rig that explains pictures of which nobody knows yet which marker is which: recognised by a rig,
/// the rig found by that, and recognised anew.
class RigReader {
 public:
  /// Of a rig that is known a few markers tell more, and are hardly taken for others.
  static constexpr std::size_t few = 2;
  /// What may be wrong with where the cameras of a rig that was found look.
  static constexpr SightDoubt of_found = {.sideways = 0.03, .roll = 0.02, .scale = 0.05};

  /// `target`: what the cameras are believed to look at, in W, m; `fewest`: markers that make a picture of
  /// use before anything is known.
  RigReader(const RigModel& guess, const RigPrior& prior, const std::array<std::size_t, 2>& cameras,
            const Eigen::Vector3d& target, std::size_t fewest);

  /// By markers as the rig that was found `before` has them, if there is one, and as long as something is
  /// amiss as the guess has them, those of one camera, or of both, taken for something else if need be; of
  /// these the rig that explains most. None is found where a camera recognises nothing.
  [[nodiscard]] RigReading read(const RigSights& sights, const RigModel* before) const;
  /// Which marker is which in the last look alone, by the rig that was found `before`, or by the guess.
  [[nodiscard]] MarkerMatch read_last(const RigSights& sights, const RigModel* before) const;

 private:
  [[nodiscard]] RigReading read_as(const RigSights& sights, const RigModel& first, const SightDoubt& doubt,
                                   const std::array<std::size_t, 2>& rank) const;
  void rate(const RigSights& sights, const std::vector<MarkerMatch>& matches, RigReading& reading) const;

  const RigModel& guess_;
  const RigPrior& prior_;
  SightDoubt doubt_;  // Of where cameras look as they were guessed.
  std::size_t fewest_;
};

}  // namespace flexura
