#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/camera/distortion.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Prior standard deviations of the errors of a camera's model. A variable with 0 is fixed. A variable with
/// infinity has no prior.
struct CameraPrior {
  double position = 0.7;          ///< Mount position in each direction, m.
  double rotation = 10 * degree;  ///< Mount rotation about each axis, rad.
  double pan_zero = 0;  ///< Pan zero, rad. Without stage motion, it is equivalent to a rotation of the mount.
  double tilt_zero = 0.035;     ///< Tilt zero, rad.
  double tilt_axis = 0.003;     ///< Position of the tilt axis in each direction, m.
  double pupil = 0.003;         ///< Position of the pupil in each direction, m.
  double pupil_shift = 0.001;   ///< Motion of the pupil with the zoom, m per unit of zoom ratio.
  double focal = 0.1;           ///< Relative error of the focal length.
  double aspect = 0.001;        ///< Relative error of fy alone.
  double principal_point = 10;  ///< Principal point in each direction, px.
  /// Distortion coefficients, in the order of the lens model.
  std::array<double, Distortion::most> distortion = {0.02, 0, 0, 0, 0, 0, 0, 0};
  double zoom_row = 0.01;  ///< Relative error of the focal length of each row of a zoom table.
  /// Error of an axis position of head or stage, in steps of the axis's resolution. The default is the
  /// standard deviation of an error that is uniformly distributed within half a step. 0: positions are exact.
  double steps = 0.288675134594812882;
};

/// Prior standard deviations of the errors of an arm. A variable with 0 is fixed.
struct ArmPrior {
  double length = 0.005;     ///< Relative error of each section's length.
  double bend_gain = 0.01;   ///< Relative error of each section's bend, equal in all poses.
  double bend_share = 0.01;  ///< Relative error of each bend, independent in each pose.
  double bend = 0.001;       ///< Additional error of each bend, rad.
  /// Error of the bends that the model predicts for a command, equal in all poses. The error of each
  /// section's bend is a sum of unknown shares of all sections' commanded bends and of its own sag. This
  /// value is the standard deviation of the shares. If `response` and `pose_response` are 0, the arm has no
  /// such errors.
  double response = 0;
  /// Standard deviation of additional shares as in `response`, which are independent in each pose.
  double pose_response = 0;
};

/// Prior standard deviations of the errors of a rig.
struct RigPrior {
  ArmPrior arm;                      ///< Priors of the arm, equal for all sections.
  std::vector<CameraPrior> cameras;  ///< Priors of the cameras, one per camera.
};

/// Returns the prior of a rough initial guess. The standard deviations are 10 degrees for rotations, 10 % for
/// focal lengths and 10 px for principal points. For a camera's position, the standard deviation is `share`
/// times the camera's distance from the point `seen` (W, m; default: the arm's base). For the zeros of tilt
/// axes, the standard deviation is 2 degrees. For the zero of the pan axis of a camera whose stage can move,
/// the standard deviation is also 2 degrees.
[[nodiscard]] RigPrior rough_prior(const RigModel& model, double share = 0.2,
                                   const std::optional<Eigen::Vector3d>& seen = {});

}  // namespace flexura
