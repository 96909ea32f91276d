#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "flexura/render/renderer.h"

namespace flexura {

/// A point of an outline curve, on the arm's surface.
struct OutlinePoint {
  double s = 0;                      ///< Arc length from the arm's base, m.
  double angle = 0;                  ///< Angle around the backbone from x of the backbone's frame at s, rad.
  Eigen::Vector3d p_CP = {0, 0, 0};  ///< Point in C, m.
  std::optional<Eigen::Vector2d>
      /// Pixel (u, v), px; missing if the point is behind the camera or outside the lens's field of view.
      pixel;
  /// Whether the point is visible: neither the arm nor anything else is in front of it.
  bool is_visible = false;
};

/// Kind of an outline curve.
enum class OutlineKind {
  contour,  ///< The curve on which rays are tangent to the tube's side.
  rim,      ///< The edge of a flat end.
};

/// An outline curve, with points in order along the curve.
struct Outline {
  OutlineKind kind = OutlineKind::contour;
  std::vector<OutlinePoint> points;
};

/// Returns the arm's outline curves as seen by the prepared renderer's camera. Points are about `step` px
/// apart, with at least 8 and at most 2000 points per arc. The first curves are contours, in order of s. Each
/// part of the arm whose side can be tangent to rays has two contours, one on each side. If such a part
/// begins or ends between the arm's ends, its two contours meet at the point where it begins or ends. After
/// the contours come the closed rims of flat ends, which start at angle 0. The outline of a round tip is a
/// contour at s = L. The result is empty without an arm. Throws std::invalid_argument for a step that is not
/// positive.
[[nodiscard]] std::vector<Outline> outlines(const Renderer& renderer, double step = 1);

}  // namespace flexura
