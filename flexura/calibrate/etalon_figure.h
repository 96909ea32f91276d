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

/// Parts of the calibration cylinder that a picture shows and whose position in space is known.
enum class EtalonPart {
  left_side,  ///< Left end of the silhouette: the line along the cylinder where the line of sight is tangent.
  right_side,  ///< Right end of the silhouette.
  upper_rim,   ///< Top of the silhouette: the mean of two places, a quarter of the width beside its middle.
  lower_rim,   ///< Bottom of the silhouette: the mean of two such places.
  red_line,
};

/// The half of a rim that bounds the silhouette: the nearer one as long as the camera does not see the end
/// face. When a camera passes the height of a rim, the other half takes over. The silhouette's motion with
/// the camera then jumps, by as much as the distances of the two halves differ.
enum class RimHalf : std::uint8_t {
  seen,  ///< The half that a camera sees from its position.
  near,
  far,
};

/// A picture point at which a part of the cylinder is seen. It lies on the part's image; its position along
/// it is unknown.
struct EtalonPoint {
  EtalonPart part = EtalonPart::left_side;
  std::size_t number = 0;  ///< Number of a red line: 0 lies towards E's +Z, 1 towards +X, and so on.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma = 0;              ///< Standard deviation across the part's image, px.
  RimHalf half = RimHalf::seen;  ///< The half of a rim with which the point is compared.
};

/// A line of W that a camera sees as the image of a part.
struct EtalonLine {
  Eigen::Vector3d point, direction;  ///< In W: a point of the line, m, and its unit direction.
};

/// The calibration cylinder as seen by cameras.
class EtalonFigure {
 public:
  /// Takes position and size from the file.
  explicit EtalonFigure(const EtalonConfig& etalon);

  /// Returns the line that a camera at p_WC sees of a part. Sides and rims move along the surface with the
  /// camera, but the line of sight is tangent there. To first order this moves nothing in the picture, so the
  /// line may be treated as fixed. Empty for a camera within the cylinder's radius. `half` selects the half
  /// of a rim and is ignored for other parts.
  [[nodiscard]] std::optional<EtalonLine> line(EtalonPart part, std::size_t number,
                                               const Eigen::Vector3d& p_WC,
                                               RimHalf half = RimHalf::seen) const;
  /// Returns the half of a rim, near or far, that a camera at p_WC sees; `seen` for other parts.
  [[nodiscard]] RimHalf half_seen(EtalonPart part, const Eigen::Vector3d& p_WC) const;
  /// Returns the point of that line (for a rim: of its tangent) nearest to the ray through the pixel. Empty
  /// if there is no line, or if the lens has no ray there.
  [[nodiscard]] std::optional<Eigen::Vector3d> nearest(const EtalonPoint& seen, const View& view) const;

  /// Predicts the points of a picture, with sigma 0: two of each side, one of each rim, and two of each
  /// red line that faces the camera within 60 degrees. Empty unless the whole cylinder is visible, at least
  /// `margin` px from the border.
  [[nodiscard]] std::optional<std::vector<EtalonPoint>> expected(const View& view, double margin) const;
  /// Number of points of each rim in an outline.
  static constexpr std::size_t rim_points = 32;
  /// Returns points of its two rims, px, equally many of each, evenly spaced around, starting at the camera's
  /// side. They bound the visible cylinder to within 0.005 of a rim's width. Empty under the conditions of
  /// `expected`.
  [[nodiscard]] std::optional<std::array<Eigen::Vector2d, 2 * rim_points>> outline(const View& view,
                                                                                   double margin) const;
  /// Returns the bearing of a red line to the right of the camera's direction around the cylinder, rad.
  [[nodiscard]] double bearing(std::size_t number, const Eigen::Vector3d& p_WC) const;

  /// Returns the midpoint of its axis, in W, m.
  [[nodiscard]] Eigen::Vector3d middle() const;
  /// Returns the unit direction of its axis, in W.
  [[nodiscard]] Eigen::Vector3d up() const { return X_WE_.rotation.col(1); }

 private:
  Pose X_WE_;
  double radius_, height_, red_radius_;
};

}  // namespace flexura
