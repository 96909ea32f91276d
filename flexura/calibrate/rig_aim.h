#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Returns the point halfway along the modelled arm for the command `state`, in W, m.
[[nodiscard]] Eigen::Vector3d arm_middle(const RigModel& model, const ArmState& state);

/// Returns the pan and tilt of the head for which a point of W is on the optical axis, with the stage and
/// zoom of `stance`. The result is neither clamped nor quantised. Throws std::out_of_range if the zoom is
/// beyond the ends of the lens's table.
[[nodiscard]] HeadState aimed(const CameraConfig& model, const RigStance& stance,
                              const Eigen::Vector3d& p_WP);

/// Returns the stage position, m, at which the camera's pupil is at a point of W, with the head as in
/// `stance`. The result is neither clamped nor quantised. If the modelled mount rotation has the error R, the
/// command changes the pupil's offset e from the point to (I - R) e. The offset decreases if the angle of R
/// is less than 60 degrees (docs/calibration-paper.md). Throws std::out_of_range if the zoom is beyond the
/// ends of the lens's table.
[[nodiscard]] Eigen::Vector3d stage_towards(const CameraConfig& model, const RigStance& stance,
                                            const Eigen::Vector3d& p_WC);

/// Returns the stance, clamped to the limits and quantised to the resolutions of head, lens and stage.
[[nodiscard]] RigStance commanded(const Camera& camera, RigStance stance);
/// Returns the head position that moves an image point onto the principal point. `off`: distance of the image
/// point from the principal point, to the right and downwards, px.
[[nodiscard]] HeadState turned_towards(HeadState head, const Intrinsics& lens, const Eigen::Vector2d& off);

/// Returns the lens positions of the shortest and the longest focal length within the head's limits.
[[nodiscard]] std::array<double, 2> zoom_ends(const Camera& camera);
/// Returns the lens position with this zoom ratio, or the nearest one within the head's limits.
[[nodiscard]] double zoom_at(const Camera& camera, double ratio);
/// Returns the lens position with `ratio` times the focal length at position `from`, or the nearest one
/// within the head's limits.
[[nodiscard]] double zoom_by(const Camera& camera, double from, double ratio);

/// Input for the configuration that section 3.4 of the paper requires: the target, the start, and what may
/// move.
struct RigGoal {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< Target of both cameras, in W, m.
  std::array<RigStance, 2> now;                      ///< Present positions of the two cameras.
  bool may_use_stages = true;                        ///< Whether stages may move.
};

/// Deviation from the required configuration, according to the model.
struct RigRemainder {
  double angle = 0;  ///< Angle between the axes minus 90 degrees, rad.
  /// Offset of each optical axis from the target, to the right and downwards, m.
  std::array<Eigen::Vector2d, 2> aim;
  double zoom_ratio = 1;  ///< Ratio of the first camera's magnification to the second's.
  std::array<double, 2> roll = {0,
                                0};  ///< Roll of each camera about its axis, rad; no head can correct a roll.
};

/// Commands for the required configuration, and the remaining deviation due to ranges and resolutions.
struct DesiredRig {
  std::array<RigStance, 2> stances;  ///< Positions to command, clamped and quantised.
  RigRemainder remainder;            ///< Deviation at these positions.
  std::vector<std::string> notes;    ///< Limits that affect the result: "front: pan ends at ...".
};

/// Returns the commands after which both cameras look at the target along orthogonal axes and show it in
/// equal size. This size is between the two present sizes. The stages make the lines of sight orthogonal by
/// the shortest move within their travel. The heads turn so that the axes coincide with the lines of sight.
/// If the stages do not reach orthogonality, each head turns by half of the missing angle: orthogonal axes
/// take priority over axes through the target. Then all positions are clamped and quantised to those
/// neighbouring positions whose axes are most nearly orthogonal. Throws std::invalid_argument for two stances
/// of one camera. Throws std::out_of_range for a camera that the model lacks, or a zoom beyond the ends of
/// its table.
[[nodiscard]] DesiredRig desired_rig(const RigModel& model, const RigGoal& rig_goal);

/// Returns the deviation for cameras in these positions. `target`: in W, m. Throws std::out_of_range for a
/// camera that the model lacks, or a zoom beyond the ends of its table.
[[nodiscard]] RigRemainder remainder(const RigModel& model, const std::array<RigStance, 2>& stances,
                                     const Eigen::Vector3d& target);

}  // namespace flexura
