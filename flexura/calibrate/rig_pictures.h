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

/// The pictures of a session. The markers in the pictures are identified again whenever the rig estimate
/// improves, because a wrong estimate leads to wrong identities.
class RigPictures {
 public:
  struct Look {
    std::size_t stance = 0, pose = 0;  ///< Indices in `stances` and `poses`.
    ArmFigure arm;
  };

  /// `marked`: the arm on which the markers' arc lengths are measured. `cameras`: indices in the rig of the
  /// cameras that take the pictures.
  RigPictures(const Arm& marked, ArmPictureConfig config, const std::array<std::size_t, 2>& cameras)
      : marked_(marked), config_(std::move(config)), cameras_(cameras) {}

  std::vector<ArmState> poses;     ///< Commanded arm poses.
  std::vector<RigStance> stances;  ///< Measured camera stances.
  std::vector<Look> looks;

  /// Identifies the markers in each picture. `pointing_prior`: prior of the pointing errors of `model`. The
  /// error of a camera is estimated from all its pictures together. `rank` selects one of the likely errors
  /// of each camera; 0 is the best. In pictures of a camera with fewer likely errors, no markers are
  /// identified.
  [[nodiscard]] std::vector<MarkerMatch> recognise(const RigModel& model, const PointingPrior& pointing_prior,
                                                   const std::array<std::size_t, 2>& rank = {0, 0}) const;
  /// Identifies only the markers of the last picture, with the most likely error from all pictures of its
  /// camera.
  [[nodiscard]] MarkerMatch recognise_last(const RigModel& model, const PointingPrior& pointing_prior) const;
  /// Returns the observations of the pictures with at least `fewest` identified markers.
  [[nodiscard]] RigObservations observations(const RigModel& model, const std::vector<MarkerMatch>& matches,
                                             std::size_t fewest) const;
  /// Returns the observations of one picture.
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
