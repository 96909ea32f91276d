#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Markers of an arm, commanded to a state, in a picture of one of two cameras.
struct ArcPicture {
  std::size_t camera = 0;
  Pose X_MC;  ///< Of the camera in its mount's frame, as head and stage say.
  ArmState state;
  std::vector<SeenMarker> markers;
};

/// Where two cameras' mounts are, by markers at known arc lengths on arcs in two planes.
struct ArcFit {
  std::string reason;                         ///< Why there is none; "" when there is.
  std::array<Pose, 2> X_WM;                   ///< At stage offset 0.
  double rms = 0;                             ///< Of the markers' residuals, px.
  std::array<double, 2> turn_sigma = {0, 0};  ///< Of how each mount is turned about W's Y, rad.
};

/// The two poses, with the arm's own errors (each section's bends wrong by 1 % and its length by 0.5 %,
/// standard deviations) taken out as far as both cameras tell them: robust least squares by the method of
/// Levenberg and Marquardt, from `start`. The lenses are known.
[[nodiscard]] ArcFit fit_arcs(const Arm& arm, const std::array<Intrinsics, 2>& lenses,
                              const std::vector<ArcPicture>& pictures, const std::array<Pose, 2>& start);

}  // namespace flexura
