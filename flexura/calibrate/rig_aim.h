#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// The middle of the arm, commanded to `state`, as the model has it: halfway along, in W, m.
[[nodiscard]] Eigen::Vector3d arm_middle(const RigModel& model, const ArmState& state);

/// The pan and tilt, as the head counts them, that bring a point of W onto the camera's optical axis, from
/// where the stance's stage and zoom stand. Not drawn to the head's limits or steps.
/// std::out_of_range: a zoom beyond the ends of the lens's table.
[[nodiscard]] HeadState aimed(const CameraConfig& model, const RigStance& stance,
                              const Eigen::Vector3d& p_WP);

/// The stage's offset, m, that brings the camera's pupil to a point of W, its head standing as in `stance`.
/// Not drawn to the stage's limits or steps. With a mount whose turn is wrong by R it brings the pupil from
/// an offset e to (I - R) e: closer where R is less than 60 degrees (docs/calibration-paper.md).
/// std::out_of_range: a zoom beyond the ends of the lens's table.
[[nodiscard]] Eigen::Vector3d stage_towards(const CameraConfig& model, const RigStance& stance,
                                            const Eigen::Vector3d& p_WC);

/// The nearest stance that can be commanded.
[[nodiscard]] RigStance commanded(const Camera& camera, RigStance stance);
/// The head turned so that what is seen `off` px to the right of and below the principal point comes there.
[[nodiscard]] HeadState turned_towards(HeadState head, const Intrinsics& lens, const Eigen::Vector2d& off);

/// The lens's positions of its shortest focal length and of its longest, within the head's limits.
[[nodiscard]] std::array<double, 2> zoom_ends(const Camera& camera);
/// The lens's position at which its ratio is this, or comes nearest to it within the head's limits.
[[nodiscard]] double zoom_at(const Camera& camera, double ratio);
/// Likewise where the focal length is `ratio` times that at position `from`.
[[nodiscard]] double zoom_by(const Camera& camera, double from, double ratio);

/// The configuration that section 3.4 of the paper asks for.
struct RigWish {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< What both cameras look at, in W, m.
  std::array<RigStance, 2> now;                      ///< From where they go: of two cameras.
  bool may_use_stages = true;                        ///< Else they stay where they stand.
};

/// What remains of it, by the model.
struct RigRemainder {
  double angle = 0;                     ///< Between the axes, beyond 90 degrees, rad.
  std::array<Eigen::Vector2d, 2> aim;   ///< By which each axis passes the target, right and down, m.
  double zoom_ratio = 1;                ///< First camera's magnification over the second's.
  std::array<double, 2> roll = {0, 0};  ///< Of each camera about its axis, rad: no head can correct it.
};

/// What to command for the wanted configuration, and what remains of it for want of range or resolution.
struct WantedRig {
  std::array<RigStance, 2> stances;  ///< To be commanded: within the limits, in steps of the resolutions.
  RigRemainder remainder;            ///< When these are commanded.
  std::vector<std::string> notes;    ///< What keeps it from being had: "front: pan ends at ...".
};

/// The commands after which both cameras look at the target along orthogonal axes and show it equally large,
/// between as large as they do now:
/// the stages (by as little as does it) bring the lines of sight to 90 degrees, as far as they travel, and
/// the heads turn along these. What the stages cannot do, the heads do half each: orthogonal axes come before
/// axes through the target. Then everything is drawn to what can be commanded; of the positions around it,
/// those whose axes are the most nearly orthogonal. std::invalid_argument: stances of one camera.
/// std::out_of_range: a camera that the model has not, a zoom beyond the ends of its table.
[[nodiscard]] WantedRig wanted_rig(const RigModel& model, const RigWish& wish);

/// What remains when cameras stand like this, `target` in W, m. std::out_of_range: likewise.
[[nodiscard]] RigRemainder remainder(const RigModel& model, const std::array<RigStance, 2>& stances,
                                     const Eigen::Vector3d& target);

}  // namespace flexura
