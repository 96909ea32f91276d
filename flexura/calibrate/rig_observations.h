#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/calibrate/etalon_figure.h"
#include "flexura/estimate/observation.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Observations of one camera in one picture: of the arm, or of the calibration cylinder.
struct RigImage {
  std::size_t stance = 0, pose = 0;      ///< Indices in RigObservations.
  std::vector<SeenMarker> markers = {};  ///< Identified markers.
  std::vector<CurvePoint> points = {};   ///< Points of the backbone, base to tip.
  std::vector<EtalonPoint> etalon = {};  ///< Points of the cylinder's borders and red lines.

  /// Returns the number of markers and points.
  [[nodiscard]] std::size_t things() const { return markers.size() + points.size() + etalon.size(); }
};

/// All observations. Pictures between which the camera did not move share a stance and its error. Pictures
/// between which the arm did not move share a pose and its error.
struct RigObservations {
  std::vector<ArmState> poses;     ///< Commanded arm poses.
  std::vector<RigStance> stances;  ///< Measured camera stances.
  std::vector<RigImage> images;
  std::optional<EtalonConfig> etalon = {};  ///< Known position of the cylinder, if there is one.
};

}  // namespace flexura
