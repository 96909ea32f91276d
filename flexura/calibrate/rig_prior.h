#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// How wrong a camera may be: standard deviations of what its description says; 0 holds a number, infinity
/// says that nothing is known of it.
struct CameraPrior {
  double position = 0.7;          ///< Of the mount, in each direction, m.
  double rotation = 10 * degree;  ///< Of the mount, about each axis, rad.
  double pan_zero = 0;            ///< rad; a turned mount does the same as long as the stage does not move.
  double tilt_zero = 0.035;       ///< rad: 2 degrees.
  double tilt_axis = 0.003;       ///< m, in each direction.
  double pupil = 0.003;           ///< m, in each direction.
  double pupil_shift = 0.001;     ///< m for each 1 of zoom ratio.
  double focal = 0.1;             ///< Share of the focal length.
  double aspect = 0.001;          ///< Share of fy alone.
  double principal_point = 10;    ///< px, in each direction.
  std::array<double, 5> distortion = {0.02, 0, 0, 0, 0};  ///< k1, k2, p1, p2, k3.
  double zoom_row = 0.01;  ///< Share of the focal length of each row of a zoom table.
  /// Of the true place of an axis of the head or the stage, in steps of its resolution: evenly anywhere
  /// within half a step. 0: counts are exact.
  double steps = 0.288675134594812882;
};

/// How wrong an arm may be: standard deviations, 0 holds.
struct ArmPrior {
  double length = 0.005;     ///< Share of each section's length.
  double bend_gain = 0.01;   ///< Share of each section's bend, the same in all poses.
  double bend_share = 0.01;  ///< Share of each bend, another in each pose.
  double bend = 0.001;       ///< And beside that, rad.
};

/// How far a rig may be off its guess: standard deviations.
struct RigPrior {
  ArmPrior arm;                      ///< The same of every section.
  std::vector<CameraPrior> cameras;  ///< One a camera.
};

/// The rough guesses that a rig may start from: 10 degrees, `share` of each camera's distance from what it
/// looks at (`seen` in W, m; the arm's base when left out), 10 % of its focal length, its principal point 10
/// px off, the zeros of its tilt axis, and of its pan axis where its stage can move, 2 degrees.
[[nodiscard]] RigPrior rough_prior(const RigModel& model, double share = 0.2,
                                   const std::optional<Eigen::Vector3d>& seen = {});

}  // namespace flexura
