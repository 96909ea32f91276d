#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// One circular arc of a backbone: a section as it stands.
struct Arc {
  Pose X_WS;             ///< Frame at the arc's start; z is the tangent.
  double s = 0.0;        ///< Arc length from the arm's base to the arc's start, m.
  double length = 0.0;   ///< m, stretch included.
  Eigen::Vector2d bend;  ///< rad, over the whole arc.

  /// Frame at `distance` in [0, length] m along the arc, in W.
  [[nodiscard]] Pose pose(double distance) const;
};

/// The arm's centreline in the world: a chain of exact circular arcs, each tangent to the one before.
class Backbone {
 public:
  /// Places the arm's sections, bent and stretched as `state` says (one entry a section, else std::invalid_argument).
  Backbone(const Arm& arm, const ArmState& state);

  [[nodiscard]] std::span<const Arc> arcs() const { return arcs_; }
  /// m, stretch included.
  [[nodiscard]] double length() const;
  /// X_WS at arc length s in [0, length()], m; s outside is an std::out_of_range.
  [[nodiscard]] Pose pose(double s) const;
  /// X_WT, the frame at s = length().
  [[nodiscard]] const Pose& tip() const { return X_WT_; }

 private:
  std::vector<Arc> arcs_;
  Pose X_WT_;
};

}  // namespace flexura
