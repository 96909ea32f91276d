#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/camera/camera_config.h"
#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/camera/view.h"
#include "flexura/model/arm.h"

namespace flexura {

/// An arm and the cameras that look at it: as they are believed to be, or as they were found. The arm's base
/// is where the world is counted from (docs/calibration.md, "Gauge").
struct RigModel {
  Arm arm;
  std::vector<double> bend_gains;  ///< Factor on each section's commanded bend; empty: all 1.
  std::vector<CameraConfig> cameras;

  /// How the arm stands when it is commanded to `state`, as far as the model knows. std::out_of_range: a
  /// state of fewer sections than there are gains.
  [[nodiscard]] ArmState bent(const ArmState& state) const;
};

/// A model of that arm and these cameras, nothing of which is known to be wrong.
[[nodiscard]] RigModel rig_model(const Arm& arm, const std::vector<CameraConfig>& cameras);

/// The camera's lens with all its numbers, also such as follow from others where the file leaves them out.
/// std::invalid_argument: as ZoomTable says.
[[nodiscard]] LensConfig spelled_out(const CameraConfig& camera);

/// The camera with its principal point moved by so much, px, the same at all zooms.
[[nodiscard]] CameraConfig with_principal_point_moved(CameraConfig camera, const Eigen::Vector2d& by);

/// How wrong a camera may be: standard deviations of what its description says; 0 holds a number, infinity
/// says that nothing is known of it.
struct CameraPrior {
  double position = 0.7;        ///< Of the mount, in each direction, m.
  double rotation = 0.1745;     ///< Of the mount, about each axis, rad: 10 degrees.
  double pan_zero = 0;          ///< rad; a turned mount does the same as long as the stage does not move.
  double tilt_zero = 0.035;     ///< rad: 2 degrees.
  double tilt_axis = 0.003;     ///< m, in each direction.
  double pupil = 0.003;         ///< m, in each direction.
  double pupil_shift = 0.001;   ///< m for each 1 of zoom ratio.
  double focal = 0.1;           ///< Share of the focal length.
  double aspect = 0.001;        ///< Share of fy alone.
  double principal_point = 10;  ///< px, in each direction.
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

/// A way in which one camera stood, as its head and stage say.
struct RigStance {
  std::size_t camera = 0;  ///< Its place in RigModel::cameras.
  HeadState head = {};
  StageState stage = {};
  /// An earlier stance (of the observations) since which the camera was neither panned nor tilted, though it
  /// may have zoomed or slid: what its head truly stands at, beside what it says, is then the same.
  std::optional<std::size_t> turned_as = {};
};

/// What a camera of a model that reads this stance sees. std::out_of_range: a camera that the model has not,
/// a zoom outside its lens's table.
[[nodiscard]] View view_of(const RigModel& model, const RigStance& stance);

}  // namespace flexura
