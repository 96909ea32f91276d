#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "flexura/camera/view.h"
#include "flexura/math/pose.h"
#include "flexura/render/renderer.h"
#include "flexura/study/study_config.h"

namespace flexura {

/// Number of points on a study's circle: every 5 degrees, counter-clockwise from the lowest point.
inline constexpr std::size_t circle_points = 72;

/// Indices, among these points, of the square's corners and of the circle's top.
inline constexpr std::size_t bottom_right = 9, top_right = 27, circle_top = 36, top_left = 45,
                             bottom_left = 63;

/// Pixels (u, v) of the target's points in an image, px; std::nullopt for points that the lens cannot image.
struct TargetImage {
  std::optional<Eigen::Vector2d> center;
  std::array<std::optional<Eigen::Vector2d>, circle_points> circle;
};

/// A study's target in the world: a circle with an inscribed square. The target's frame F has a horizontal x
/// axis, a y axis that is as nearly vertical as possible, and z along the normal. For a horizontal plane, x
/// is W's X.
class StudyTarget {
 public:
  explicit StudyTarget(const StudyTargetConfig& config);

  [[nodiscard]] const Eigen::Vector3d& center() const { return X_WF_.position; }
  /// Returns the unit vector in W of the horizontal axis in the target's plane.
  [[nodiscard]] Eigen::Vector3d level_axis() const { return X_WF_.rotation.col(0); }
  [[nodiscard]] const Pose& frame() const { return X_WF_; }
  [[nodiscard]] double radius() const { return radius_; }
  /// Returns point number i of the circle in W, m.
  [[nodiscard]] Eigen::Vector3d point(std::size_t i) const;
  /// Returns point number i of the circle in the target's x and y, m.
  [[nodiscard]] Eigen::Vector2d plane_point(std::size_t i) const;

  /// Returns the target's image, computed by the projection formulas.
  [[nodiscard]] TargetImage projected(const View& view) const;

  /// Returns the target's image, computed by the renderer: the image points whose rays hit the target's
  /// points on a screen in the target's plane. The search for a point starts at the middle of the nearest
  /// pixel. Points are std::nullopt if the rays are parallel to the screen. Afterwards, `renderer` must be
  /// prepared again before other uses.
  [[nodiscard]] TargetImage rendered(const View& view, Renderer& renderer) const;

 private:
  Pose X_WF_;
  double radius_;
};

}  // namespace flexura
