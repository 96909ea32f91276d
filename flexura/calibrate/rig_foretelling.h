#pragma once

#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// How a picture agrees with a rig in whose finding it had no part.
struct RigForetelling {
  double px = 0;      ///< How far what is seen is from where it was foretold, root mean square.
  double sigmas = 0;  ///< The same in units of what is not known of rig, head, arm and picture together.
};

/// Holds a picture of its own against the rig that was found by `problem`: taken from this stance, with the
/// arm in this pose, as both say of themselves. `image` names stance 0 and pose 0. `least`: what no thing's
/// place is foretold better than, px. Infinite where the rig would not show what was seen.
[[nodiscard]] RigForetelling foretell(const RigProblem& problem, const RigCalibration& found,
                                      const RigStance& stance, const ArmState& pose, const RigImage& image,
                                      double least);

}  // namespace flexura
