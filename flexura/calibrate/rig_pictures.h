#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/arm_picture.h"
#include "flexura/calibrate/marker_vote.h"
#include "flexura/calibrate/rig_observations.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Returns the number of visible markers.
[[nodiscard]] std::size_t markers_of(const MarkerScene& scene);

/// The pictures of a session. Their markers are identified again whenever the rig estimate improves, as a
/// wrong rig misidentifies markers.
class RigPictures {
 public:
  struct Look {
    std::size_t stance = 0, pose = 0;  ///< Indices in `stances` and `poses`.
    ArmFigure arm;
  };

  /// `marked`: the arm along which marker positions are measured; `cameras`: those of the rig that look.
  RigPictures(const Arm& marked, ArmPictureConfig config, const std::array<std::size_t, 2>& cameras)
      : marked_(marked), config_(std::move(config)), cameras_(cameras) {}

  std::vector<ArmState> poses;     ///< Arm poses as commanded.
  std::vector<RigStance> stances;  ///< Camera stances as read.
  std::vector<Look> looks;

  /// Identifies the markers in each look, if the rig is `model` up to `pointing_prior`; all looks of a camera
  /// together determine its error. `rank` selects the likely error of each camera, 0 for the best; a camera
  /// with fewer likely errors gets no identities.
  [[nodiscard]] std::vector<MarkerMatch> recognise(const RigModel& model, const PointingPrior& pointing_prior,
                                                   const std::array<std::size_t, 2>& rank = {0, 0}) const;
  /// Identifies the markers of the last look alone, by the likeliest error from all looks of its camera.
  [[nodiscard]] MarkerMatch recognise_last(const RigModel& model, const PointingPrior& pointing_prior) const;
  /// Returns the observations of the looks with at least `fewest` identified markers.
  [[nodiscard]] RigObservations observations(const RigModel& model, const std::vector<MarkerMatch>& matches,
                                             std::size_t fewest) const;
  /// Returns the observations of one look.
  [[nodiscard]] SeenArm seen(const RigModel& model, std::size_t look, const MarkerMatch& match) const;

 private:
  [[nodiscard]] MarkerPicture picture(const RigModel& model, const Look& look) const;
  // For the looks of one camera; leaves the other matches as they are.
  void recognise(const RigModel& model, const PointingPrior& pointing_prior, std::size_t camera,
                 std::size_t rank, std::vector<MarkerMatch>& matches) const;

  const Arm& marked_;
  ArmPictureConfig config_;
  std::array<std::size_t, 2> cameras_;
};

}  // namespace flexura
