#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/arm_picture.h"
#include "flexura/calibrate/marker_vote.h"
#include "flexura/calibrate/rig_observations.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// How many of them can be recognised.
[[nodiscard]] std::size_t markers_of(const MarkerScene& scene);

/// The pictures of a session, whose markers are recognised anew whenever more is known of the rig: a rig that
/// was guessed wrong takes markers for others.
class RigSights {
 public:
  struct Look {
    std::size_t stance = 0, pose = 0;  ///< Which of those below.
    ArmFigure arm;
  };

  /// The arm as its markers' places are told, and what `cameras` of the rig look.
  RigSights(const Arm& marked, ArmPictureConfig config, const std::array<std::size_t, 2>& cameras)
      : marked_(marked), config_(std::move(config)), cameras_(cameras) {}

  std::vector<ArmState> poses;     ///< As commanded.
  std::vector<RigStance> stances;  ///< As read.
  std::vector<Look> looks;

  /// Which marker is which in each look, if the rig is `model` up to `doubt`: all looks of a camera together
  /// tell what is wrong with it. `rank`: by which of the likely errors of each camera, the best one first;
  /// nothing is recognised of a camera that has no so many.
  [[nodiscard]] std::vector<MarkerMatch> recognise(const RigModel& model, const SightDoubt& doubt,
                                                   const std::array<std::size_t, 2>& rank = {0, 0}) const;
  /// Of the last look alone, by all looks of its camera and their likeliest error.
  [[nodiscard]] MarkerMatch recognise_last(const RigModel& model, const SightDoubt& doubt) const;
  /// What the looks tell, recognised so, that have this many markers at least.
  [[nodiscard]] RigObservations observations(const RigModel& model, const std::vector<MarkerMatch>& matches,
                                             std::size_t fewest) const;
  /// What one of them tells.
  [[nodiscard]] SeenArm seen(const RigModel& model, std::size_t look, const MarkerMatch& match) const;

 private:
  [[nodiscard]] MarkerPicture picture(const RigModel& model, const Look& look) const;
  // The looks of one camera; the others' matches stay as they are.
  void recognise(const RigModel& model, const SightDoubt& doubt, std::size_t camera, std::size_t rank,
                 std::vector<MarkerMatch>& matches) const;

  const Arm& marked_;
  ArmPictureConfig config_;
  std::array<std::size_t, 2> cameras_;
};

}  // namespace flexura
