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

/// Returns the bends for which the whole arm is one circular arc that turns by `bend` rad towards a direction
/// of W. See steps 1 and 7 of section 3.4: the share of each section by its length, and the rotation about
/// the base axis. Empty if the arm cannot: a planar arm out of its plane, a base axis along the direction, or
/// a section that does not bend that far.
[[nodiscard]] std::optional<ArmState> arc_state(const Arm& arm, double bend, const Eigen::Vector3d& towards);

/// Poses that the cameras should reach, from the simulator: each camera looks along the normal of its arc's
/// plane.
struct ArcPlan {
  std::array<ArmState, 2> arcs;  ///< In XOY for the first camera, in ZOY for the second.
  /// Centers (m) and normals of the arc circles, in W; the cameras look along -normal.
  std::array<Eigen::Vector3d, 2> centers, normals;
  double radius = 0;                            ///< Radius of the arc circles, m.
  Eigen::Vector3d target;                       ///< Point where the optical axes should meet, in W, m.
  std::array<View, 2> ideal;                    ///< Target views of the cameras.
  std::array<Image<std::uint8_t>, 2> pictures;  ///< Ideal images: what each ideal view shows of its arc.
  std::array<double, 2> zoom = {1, 1};          ///< Lens positions of the ideal views.
};

/// Computes the plan for the modelled cameras and reports it to the observers of the loop. With
/// `aims_at_centers` each camera aims at the centre of its circle; otherwise both aim at the middle of the
/// space that the arcs occupy. Returns the reason if there is no plan.
[[nodiscard]] std::optional<std::string> plan_arcs(LookLoop& loop, bool aims_at_centers, ArcPlan& plan);

}  // namespace flexura
