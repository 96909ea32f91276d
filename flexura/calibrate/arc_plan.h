#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/image.h"
#include "flexura/calibrate/look_loop.h"
#include "flexura/camera/view.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Returns the bends for which the whole arm is one circular arc of the angle `bend`, rad, towards a
/// direction in W. Each section bends in proportion to its length (steps 1 and 7 of the paper's section 3.4).
/// Returns std::nullopt if the arm cannot form this arc. Possible reasons are: the arc leaves a planar arm's
/// plane, the direction is not perpendicular to the base axis, or a section's limit is exceeded.
[[nodiscard]] std::optional<ArmState> arc_state(const Arm& arm, double bend, const Eigen::Vector3d& towards);

/// Camera poses for the calibration with arcs, computed with the simulator. Each camera looks along the
/// normal of the plane of its arc.
struct ArcPlan {
  std::array<ArmState, 2>
      arcs;  ///< Shapes of the arm: an arc in XOY for the first camera, and one in ZOY for the second camera.
  /// Centers (m) and normals of the circles of the arcs, in W. The cameras look along -normal.
  std::array<Eigen::Vector3d, 2> centers, normals;
  double radius = 0;          ///< Radius of the circles of the arcs, m.
  Eigen::Vector3d target;     ///< Point where the optical axes should meet, in W, m.
  std::array<View, 2> ideal;  ///< Target views of the cameras.
  std::array<Image<std::uint8_t>, 2>
      pictures;                         ///< Ideal images: rendered pictures of each arc in its ideal view.
  std::array<double, 2> zoom = {1, 1};  ///< Lens positions of the ideal views.
};

/// Computes the plan for the modelled cameras and reports it to the watcher of `loop`. If `aims_at_centers`
/// is true, each camera aims at the centre of its circle. Otherwise, both cameras aim at the middle of the
/// space that the arcs occupy. If no plan is possible, returns the reason.
[[nodiscard]] std::optional<std::string> plan_arcs(LookLoop& loop, bool aims_at_centers, ArcPlan& plan);

}  // namespace flexura
