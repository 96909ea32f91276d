#pragma once

#include <cstddef>
#include <vector>

#include "flexura/calibrate/rig_model.h"
#include "flexura/estimate/sighting.h"
#include "flexura/model/arm.h"

namespace flexura {

/// What one camera saw of the arm in one picture.
struct RigImage {
  std::size_t stance = 0, pose = 0;      ///< Which of the observations'.
  std::vector<SeenMarker> markers = {};  ///< Those that were recognised.
  std::vector<CurvePoint> points = {};   ///< Where the backbone is seen, from base to tip.
};

/// Everything that was seen. Pictures that were taken without moving the head share a stance, and those taken
/// without moving the arm a pose: what is wrong with it is then wrong with all of them alike.
struct RigObservations {
  std::vector<ArmState> poses;     ///< As commanded.
  std::vector<RigStance> stances;  ///< As read.
  std::vector<RigImage> images;
};

}  // namespace flexura
