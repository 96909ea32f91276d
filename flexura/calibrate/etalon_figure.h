#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/math/pose.h"
#include "flexura/model/stand.h"

namespace flexura {

/// Parts of the calibration cylinder that are visible in pictures and have a known position in space.
enum class EtalonPart {
  left_side,  ///< Left end of the silhouette: the line along the cylinder where the line of sight is tangent.
  right_side,  ///< Right end of the silhouette.
  /// Top of the silhouette: mean of two points, a quarter of the width to the left and right of the middle.
  upper_rim,
  /// Bottom of the silhouette: mean of two points, a quarter of the width to the left and right of the
  /// middle.
  lower_rim,
  red_line,
};

/// The half of a rim that bounds the silhouette. If the end face is invisible, this is the nearer half;
/// otherwise the farther half. The half changes when a camera passes the height of the rim. Then the
/// derivative of the silhouette with respect to the camera jumps, because the two halves have different
/// distances.
enum class RimHalf : std::uint8_t {
  seen,  ///< The half that bounds the silhouette, seen from the camera's position.
  near,
  far,
};

/// A picture point on the image of a part of the cylinder. The position of the point along this image is
/// unknown.
struct EtalonPoint {
  EtalonPart part = EtalonPart::left_side;
  /// Number of the red line: line 0 is towards +Z of the cylinder's frame E, line 1 towards +X, line 2
  /// towards -Z, line 3 towards -X.
  std::size_t number = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma = 0;              ///< Standard deviation perpendicular to the part's image, px.
  RimHalf half = RimHalf::seen;  ///< For a rim: the half with which the point is compared.
};

/// A line in W whose image, for one camera, coincides with the image of a part of the cylinder.
struct EtalonLine {
  Eigen::Vector3d point, direction;  ///< A point of the line, m, and its unit direction, in W.
};

/// The calibration cylinder as seen by cameras.
class EtalonFigure {
 public:
  /// `etalon`: position and size of the cylinder.
  explicit EtalonFigure(const EtalonConfig& etalon);

  /// Returns the line whose image coincides with that of this part, for a camera at p_WC. The lines of sides
  /// and rims move along the surface if the camera moves. The line of sight is tangent to the surface there,
  /// so to first order this motion does not change the picture. The line may therefore be treated as fixed.
  /// Returns std::nullopt for a camera within the cylinder's radius. `half` selects the half of a rim and is
  /// ignored for other parts.
  [[nodiscard]] std::optional<EtalonLine> line(EtalonPart part, std::size_t number,
                                               const Eigen::Vector3d& p_WC,
                                               RimHalf half = RimHalf::seen) const;
  /// Returns the half of a rim (near or far) that bounds the silhouette for a camera at p_WC. Returns `seen`
  /// for other parts.
  [[nodiscard]] RimHalf half_seen(EtalonPart part, const Eigen::Vector3d& p_WC) const;
  /// Returns the point of the part's line (for a rim: of its tangent) nearest to the ray through the pixel.
  /// Returns std::nullopt if there is no line, or if the lens has no ray for the pixel.
  [[nodiscard]] std::optional<Eigen::Vector3d> nearest(const EtalonPoint& seen, const View& view) const;

  /// Predicts the points of a picture, with sigma 0: two on each side, one on each rim, and two on each red
  /// line that faces the camera within 60 degrees. Returns std::nullopt unless the whole cylinder is visible,
  /// at least `margin` px from the border.
  [[nodiscard]] std::optional<std::vector<EtalonPoint>> expected(const View& view, double margin) const;
  /// Number of points of each rim in an outline.
  static constexpr std::size_t rim_points = 32;
  /// Returns the pixels of rim_points points on each of the two rims, evenly spaced, starting at the camera's
  /// side. The polygon through these pixels approximates the outline of the cylinder within 0.005 of a rim's
  /// width. Returns std::nullopt unless the whole cylinder is visible, at least `margin` px from the border.
  [[nodiscard]] std::optional<std::array<Eigen::Vector2d, 2 * rim_points>> outline(const View& view,
                                                                                   double margin) const;
  /// Returns the angle of a red line around the cylinder's axis, rad. The angle is measured to the right from
  /// the direction to the camera.
  [[nodiscard]] double bearing(std::size_t number, const Eigen::Vector3d& p_WC) const;

  /// Returns the midpoint of the cylinder's axis, in W, m.
  [[nodiscard]] Eigen::Vector3d middle() const;
  /// Returns the unit direction of the cylinder's axis, in W.
  [[nodiscard]] Eigen::Vector3d up() const { return X_WE_.rotation.col(1); }

 private:
  Pose X_WE_;
  double radius_, height_, red_radius_;
};

}  // namespace flexura
