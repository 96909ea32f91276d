#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/calibrate/etalon_figure.h"
#include "flexura/estimate/sighting.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// What one camera saw in one picture: of the arm, or of the calibration cylinder.
struct RigImage {
  std::size_t stance = 0, pose = 0;      ///< Which of the observations'.
  std::vector<SeenMarker> markers = {};  ///< Those that were recognised.
  std::vector<CurvePoint> points = {};   ///< Where the backbone is seen, from base to tip.
  std::vector<EtalonPoint> etalon = {};  ///< Of the cylinder's borders and red lines.

  /// How many things were seen.
  [[nodiscard]] std::size_t things() const { return markers.size() + points.size() + etalon.size(); }
};

/// Everything that was seen. Pictures that were taken without moving the head share a stance, and those taken
/// without moving the arm a pose: what is wrong with it is then wrong with all of them alike.
struct RigObservations {
  std::vector<ArmState> poses;     ///< As commanded.
  std::vector<RigStance> stances;  ///< As read.
  std::vector<RigImage> images;
  std::optional<EtalonConfig> etalon = {};  ///< If there is one: known to stand there.
};

}  // namespace flexura
