#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "flexura/render/renderer.h"

namespace flexura {

/// A point of an outline curve on the arm's surface.
struct OutlinePoint {
  double s = 0;                          ///< Arc length from the arm's base, m.
  double angle = 0;                      ///< Angle around the backbone from the frame's x at s, rad.
  Eigen::Vector3d p_CP = {0, 0, 0};      ///< Point in C, m.
  std::optional<Eigen::Vector2d> pixel;  ///< Empty: behind the camera, or outside the lens's field.
  bool is_visible = false;               ///< Whether nothing is in front of it, the arm included.
};

/// Kind of an outline curve.
enum class OutlineKind {
  contour,  ///< Where rays are tangent to the tube's side.
  rim,      ///< The edge of a flat end.
};

/// In order along the curve.
struct Outline {
  OutlineKind kind = OutlineKind::contour;
  std::vector<OutlinePoint> points;
};

/// Returns the arm's outline curves as seen by the prepared renderer's camera. Points are about `step` px
/// apart (at least 8 per arc, at most 2000). First the contours in order of s: for each part of the arm whose
/// side can be tangent to rays, one to each side. Where such a part begins or ends within the arm, both share
/// the point. Then the rims of the flat ends, closed, starting at angle 0; a round tip's contour counts as a
/// contour at s = L. Empty without an arm. Throws std::invalid_argument for a step that is not positive.
[[nodiscard]] std::vector<Outline> outlines(const Renderer& renderer, double step = 1);

}  // namespace flexura
