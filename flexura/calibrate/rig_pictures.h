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

/// The pictures of a session. Their markers are identified again whenever the rig estimate improves, because
/// a wrong rig leads to wrong identities.
class RigPictures {
 public:
  struct Look {
    std::size_t stance = 0, pose = 0;  ///< Indices in `stances` and `poses`.
    ArmFigure arm;
  };

  /// `marked`: the arm along which marker positions are measured. `cameras`: indices in the rig of the
  /// cameras that take the pictures.
  RigPictures(const Arm& marked, ArmPictureConfig config, const std::array<std::size_t, 2>& cameras)
      : marked_(marked), config_(std::move(config)), cameras_(cameras) {}

  std::vector<ArmState> poses;     ///< Arm poses as commanded.
  std::vector<RigStance> stances;  ///< Camera stances as read.
  std::vector<Look> looks;

  /// Identifies the markers in each look. The true rig is `model` with errors of the prior `pointing_prior`,
  /// which follow from all looks of a camera together. `rank` selects one of the likely errors of each
  /// camera, 0 for the best. Looks of a camera with fewer likely errors get no identities.
  [[nodiscard]] std::vector<MarkerMatch> recognise(const RigModel& model, const PointingPrior& pointing_prior,
                                                   const std::array<std::size_t, 2>& rank = {0, 0}) const;
  /// Identifies the markers of the last look only, with the likeliest error from all looks of its camera.
  [[nodiscard]] MarkerMatch recognise_last(const RigModel& model, const PointingPrior& pointing_prior) const;
  /// Returns the observations of the looks with at least `fewest` identified markers.
  [[nodiscard]] RigObservations observations(const RigModel& model, const std::vector<MarkerMatch>& matches,
                                             std::size_t fewest) const;
  /// Returns the observations of one look.
  [[nodiscard]] SeenArm seen(const RigModel& model, std::size_t look, const MarkerMatch& match) const;

 private:
  [[nodiscard]] MarkerPicture picture(const RigModel& model, const Look& look) const;
  // Identifies the markers in the looks of one camera; does not change the matches of other looks.
  void recognise(const RigModel& model, const PointingPrior& pointing_prior, std::size_t camera,
                 std::size_t rank, std::vector<MarkerMatch>& matches) const;

  const Arm& marked_;
  ArmPictureConfig config_;
  std::array<std::size_t, 2> cameras_;
};

}  // namespace flexura
