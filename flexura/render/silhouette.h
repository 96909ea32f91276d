#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "flexura/render/renderer.h"

namespace flexura {

/// A point of a curve on the arm's surface that draws its outline.
struct OutlinePoint {
  double s = 0;                          ///< m from the arm's base.
  double angle = 0;                      ///< Around the backbone from the frame's x at s, rad.
  Eigen::Vector3d p_CP = {0, 0, 0};      ///< m.
  std::optional<Eigen::Vector2d> pixel;  ///< None: behind the camera, or outside the lens's field.
  bool is_visible = false;               ///< Nothing stands in front of it, the arm itself included.
};

/// Which of the arm's curves an outline is.
enum class OutlineKind {
  contour,  ///< Where rays touch the tube's side.
  rim,      ///< The edge of a flat end.
};

/// In order along the curve.
struct Outline {
  OutlineKind kind = OutlineKind::contour;
  std::vector<OutlinePoint> points;
};

/// The curves that draw the arm's outline as the prepared renderer's camera sees it, points about `step` px
/// apart (no fewer than 8 an arc, no more than 2000). Contours, in order of s: of each stretch of the arm
/// whose side rays can touch, one to each side; where such a stretch begins or ends within the arm the two
/// share the point. Then the rims of the flat ends, closed, from angle 0 on; a round tip's contour counts as
/// a contour at s = L. Without an arm: none. std::invalid_argument: a step that is not positive.
[[nodiscard]] std::vector<Outline> outlines(const Renderer& renderer, double step = 1);

}  // namespace flexura
