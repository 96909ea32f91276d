#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Prior standard deviations of the errors of a camera's description. 0 holds a variable, infinity leaves it
/// without a prior.
struct CameraPrior {
  double position = 0.7;          ///< Mount position in each direction, m.
  double rotation = 10 * degree;  ///< Mount rotation about each axis, rad.
  double pan_zero = 0;            ///< rad; equivalent to a rotated mount as long as the stage does not move.
  double tilt_zero = 0.035;       ///< rad, 2 degrees.
  double tilt_axis = 0.003;       ///< m, in each direction.
  double pupil = 0.003;           ///< m, in each direction.
  double pupil_shift = 0.001;     ///< m per unit of zoom ratio.
  double focal = 0.1;             ///< Relative error of the focal length.
  double aspect = 0.001;          ///< Relative error of fy alone.
  double principal_point = 10;    ///< px, in each direction.
  std::array<double, 5> distortion = {0.02, 0, 0, 0, 0};  ///< k1, k2, p1, p2, k3.
  double zoom_row = 0.01;  ///< Relative error of the focal length of each row of a zoom table.
  /// Error of an axis position of head or stage, in steps of its resolution: uniform within half a step. 0:
  /// counts are exact.
  double steps = 0.288675134594812882;
};

/// Prior standard deviations of the errors of an arm; 0 holds a variable.
struct ArmPrior {
  double length = 0.005;     ///< Relative error of each section's length.
  double bend_gain = 0.01;   ///< Relative error of each section's bend, equal in all poses.
  double bend_share = 0.01;  ///< Relative error of each bend, independent in each pose.
  double bend = 0.001;       ///< Additional error of each bend, rad.
};

/// Prior standard deviations of the errors of a rig.
struct RigPrior {
  ArmPrior arm;                      ///< Equal for all sections.
  std::vector<CameraPrior> cameras;  ///< One per camera.
};

/// Returns the prior of a rough initial guess. Rotations have 10 degrees, positions `share` of each camera's
/// distance from its target (`seen` in W, m; default: the arm's base). Focal lengths have 10 %, principal
/// points 10 px. The zeros of tilt axes have 2 degrees, and so have those of pan axes whose stage can move.
[[nodiscard]] RigPrior rough_prior(const RigModel& model, double share = 0.2,
                                   const std::optional<Eigen::Vector3d>& seen = {});

}  // namespace flexura
