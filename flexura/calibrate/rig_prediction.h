#pragma once

#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// Agreement of a picture with a rig that was estimated without it.
struct RigPrediction {
  double px = 0;  ///< Prediction error of the observations, root mean square, px.
  /// Prediction error in units of the combined uncertainty of rig, head, arm and picture.
  double sigmas = 0;
};

/// Compares a picture with its prediction by the rig estimated from `problem`. `stance` and `pose` were read
/// when the picture was taken. `image` refers to stance 0 and pose 0. `least`: smallest standard deviation of
/// a predicted position, px. Infinite if the estimated rig would not show the observations.
[[nodiscard]] RigPrediction predict_image(const RigProblem& problem, const RigCalibration& found,
                                          const RigStance& stance, const ArmState& pose,
                                          const RigImage& image, double least);

}  // namespace flexura
