#pragma once

#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// Agreement of a picture with a rig estimate that does not use this picture.
struct RigPrediction {
  double px = 0;  ///< Prediction error of the observations, root mean square, px.
  /// Prediction error divided by the combined standard deviation of rig, head, arm and picture.
  double sigmas = 0;
};

/// Compares a picture with its prediction by the rig estimated from `problem`. `stance` and `pose` were
/// measured when the picture was taken. `image` must refer to stance 0 and pose 0. `least`: lower limit of
/// the standard deviation of a predicted position, px. The result is infinite if the observed points would be
/// invisible for the estimated rig.
[[nodiscard]] RigPrediction predict_image(const RigProblem& problem, const RigCalibration& found,
                                          const RigStance& stance, const ArmState& pose,
                                          const RigImage& image, double least);

}  // namespace flexura
