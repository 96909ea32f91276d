#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// The frame at the end of an arc, in the frame at its start (origin there, z along the tangent): an arc of
/// `length` m bent by `bend` rad, smooth through bend = 0. With t = |bend| its end lies at length (bend_x (1
/// - cos t)/t^2, bend_y (1 - cos t)/t^2, sin t/t), turned by the rotation vector (-bend_y, bend_x, 0).
[[nodiscard]] Pose arc_pose(const Eigen::Vector2d& bend, double length);
/// The same for who knows sinc(t) and cosc(t) (math/series.h).
[[nodiscard]] Pose arc_pose(const Eigen::Vector2d& bend, double length, double sinc_t, double cosc_t);

/// One circular arc of a backbone: a section as it stands.
struct Arc {
  Pose X_WS;                                       ///< Frame at the arc's start; z is the tangent.
  double s = 0.0;                                  ///< Arc length from the arm's base to the arc's start, m.
  double length = 0.0;                             ///< m, stretch included.
  Eigen::Vector2d bend = Eigen::Vector2d::Zero();  ///< rad, over the whole arc.

  /// Frame at `distance` in [0, length] m along the arc, in W.
  [[nodiscard]] Pose pose(double distance) const;
};

/// The arm's centreline in the world: a chain of exact circular arcs, each tangent to the one before.
class Backbone {
 public:
  /// Places the arm's sections, bent and stretched as `state` says.
  /// std::invalid_argument: no sections, not one finite bend and one stretch a section, a length that is not
  /// positive.
  Backbone(const Arm& arm, const ArmState& state);

  /// One a section, base first.
  [[nodiscard]] std::span<const Arc> arcs() const { return arcs_; }
  /// m, stretch included.
  [[nodiscard]] double length() const;
  /// X_WS at arc length s in [0, length()], m. Past an end by no more than rounding (1e-12 of the length) is
  /// at that end; further outside is an std::out_of_range.
  [[nodiscard]] Pose pose(double s) const;
  /// X_WT, the frame at s = length().
  [[nodiscard]] const Pose& tip() const { return X_WT_; }

 private:
  std::vector<Arc> arcs_;
  Pose X_WT_;
};

}  // namespace flexura
