#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Returns the middle of the modelled arm, halfway along its length, in W, m, when commanded to `state`.
[[nodiscard]] Eigen::Vector3d arm_middle(const RigModel& model, const ArmState& state);

/// Returns pan and tilt, as the head counts them, that bring a point of W onto the optical axis, for the
/// stance's stage and zoom. Neither clamped nor quantised. Throws std::out_of_range if the zoom is beyond the
/// ends of the lens's table.
[[nodiscard]] HeadState aimed(const CameraConfig& model, const RigStance& stance,
                              const Eigen::Vector3d& p_WP);

/// Returns the stage offset, m, that brings the camera's pupil to a point of W with the head as in `stance`.
/// Neither clamped nor quantised. With a mount rotation wrong by R it brings the pupil from an offset e to (I
/// - R) e. This is closer if R is less than 60 degrees (docs/calibration-paper.md). Throws std::out_of_range
/// if the zoom is beyond the ends of the lens's table.
[[nodiscard]] Eigen::Vector3d stage_towards(const CameraConfig& model, const RigStance& stance,
                                            const Eigen::Vector3d& p_WC);

/// Returns the stance clamped and quantised.
[[nodiscard]] RigStance commanded(const Camera& camera, RigStance stance);
/// Returns the head position that moves a point `off` px to the right of and below the principal point onto
/// it.
[[nodiscard]] HeadState turned_towards(HeadState head, const Intrinsics& lens, const Eigen::Vector2d& off);

/// Returns the lens positions of the shortest and the longest focal length within the head's limits.
[[nodiscard]] std::array<double, 2> zoom_ends(const Camera& camera);
/// Returns the lens position with this zoom ratio, or the nearest one within the head's limits.
[[nodiscard]] double zoom_at(const Camera& camera, double ratio);
/// Returns the lens position with `ratio` times the focal length at position `from`, or the nearest one
/// within the head's limits.
[[nodiscard]] double zoom_by(const Camera& camera, double from, double ratio);

/// The configuration that section 3.4 of the paper asks for.
struct RigGoal {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< Target of both cameras, in W, m.
  std::array<RigStance, 2> now;                      ///< Start positions of two cameras.
  bool may_use_stages = true;                        ///< Otherwise the stages stay in place.
};

/// Deviation from that configuration, by the model.
struct RigRemainder {
  double angle = 0;  ///< Angle between the axes minus 90 degrees, rad.
  /// Offset of each axis from the target, to the right and downwards, m.
  std::array<Eigen::Vector2d, 2> aim;
  double zoom_ratio = 1;                ///< First camera's magnification over the second's.
  std::array<double, 2> roll = {0, 0};  ///< Roll of each camera about its axis, rad: no head can correct it.
};

/// Commands for the wanted configuration, and the deviation that ranges and resolutions leave.
struct DesiredRig {
  std::array<RigStance, 2> stances;  ///< Positions to command, clamped and quantised.
  RigRemainder remainder;            ///< Deviation at these positions.
  std::vector<std::string> notes;    ///< What limits the result: "front: pan ends at ...".
};

/// Returns the commands after which both cameras look at the target along orthogonal axes and show it equally
/// large: between the present two sizes. The stages make the lines of sight orthogonal by the shortest move
/// within their travel, and the heads turn along them. What the stages cannot do, the heads do half each:
/// orthogonal axes take priority over axes through the target. Then everything is clamped and quantised; of
/// the positions around, those with the most nearly orthogonal axes are taken. Throws std::invalid_argument
/// for two stances of one camera. Throws std::out_of_range for a camera that the model lacks, or a zoom
/// beyond the ends of its table.
[[nodiscard]] DesiredRig desired_rig(const RigModel& model, const RigGoal& rig_goal);

/// Returns the deviation for cameras in these positions, `target` in W, m. Throws std::out_of_range for a
/// camera that the model lacks, or a zoom beyond the ends of its table.
[[nodiscard]] RigRemainder remainder(const RigModel& model, const std::array<RigStance, 2>& stances,
                                     const Eigen::Vector3d& target);

}  // namespace flexura
