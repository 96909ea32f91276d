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

/// The bends after which the whole arm is one arc of a circle that turns by `bend` rad towards a direction of
/// W (steps 1 and 7 of section 3.4: each section's share of the bend, by its length, and how that is rotated
/// about the base's axis). None where the arm cannot: a planar arm out of its plane, a base that points along
/// the direction, a section that does not bend so far.
[[nodiscard]] std::optional<ArmState> arc_state(const Arm& arm, double bend, const Eigen::Vector3d& towards);

/// Where the cameras shall stand, as the simulator has it: each looks along the normal of its arc's plane.
struct ArcPlan {
  std::array<ArmState, 2> arcs;  ///< In XOY, for the first camera, and in ZOY.
  std::array<Eigen::Vector3d, 2> centers,
      normals;                ///< Of the arcs' circles, in W; the cameras look along -normal.
  double radius = 0;          ///< m
  Eigen::Vector3d target;     ///< Where the axes shall meet.
  std::array<View, 2> ideal;  ///< What the cameras shall be,
  std::array<Image<std::uint8_t>, 2> pictures;  ///< and would see each of its arc: the ideal images.
  std::array<double, 2> zoom = {1, 1};          ///< Positions of the lenses for that.
};

/// The plan for cameras as they are believed to be; `aims_at_centers`: each at its circle's centre, or both
/// at the middle of the space that the arcs take. Those who watch are told of it. Or why there is none.
[[nodiscard]] std::optional<std::string> plan_arcs(LookLoop& loop, bool aims_at_centers, ArcPlan& plan);

}  // namespace flexura
