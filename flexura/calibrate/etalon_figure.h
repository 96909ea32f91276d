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

/// What a picture shows of the calibration cylinder that is known in space.
enum class EtalonPart {
  left_side,   ///< Where the silhouette ends on the left: a line along the cylinder that sight grazes.
  right_side,  ///< Likewise on the right.
  upper_rim,  ///< Where it ends at the top: the mean of two places, a quarter of the width beside its middle.
  lower_rim,  ///< Likewise at the bottom.
  red_line,
};

/// Which half of a rim ends the silhouette: the one nearer to the camera as long as this does not see the
/// end's face. Where a camera passes the height of a rim, it is the other from then on, and how the
/// silhouette moves with the camera jumps: by as much as the two halves' distances differ.
enum class RimHalf : std::uint8_t {
  seen,  ///< The one that a camera sees from where it is.
  near,
  far,
};

/// A point of a picture at which a part of the cylinder is seen. It lies on the part's image, nobody knows
/// where along it.
struct EtalonPoint {
  EtalonPart part = EtalonPart::left_side;
  std::size_t number = 0;  ///< Of a red line: 0 lies towards E's +Z, 1 towards +X, and so on.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma = 0;              ///< Across the part's image, px.
  RimHalf half = RimHalf::seen;  ///< Of a rim, against which the point is held.
};

/// A line of W that a camera sees where it sees a part.
struct EtalonLine {
  Eigen::Vector3d point, direction;  ///< In W: a point of it, m, and its direction, unit.
};

/// The calibration cylinder as cameras see it.
class EtalonFigure {
 public:
  /// Where a file has it, and as large as there.
  explicit EtalonFigure(const EtalonConfig& etalon);

  /// The line that a camera at p_WC sees of a part. As the camera moves, sides and rims wander along the
  /// cylinder's surface, which sight grazes there: to first order that moves nothing in the picture, so that
  /// the line may be taken to rest. None for a camera within the cylinder's radius. `half` says of which half
  /// of a rim; of other parts nothing.
  [[nodiscard]] std::optional<EtalonLine> line(EtalonPart part, std::size_t number,
                                               const Eigen::Vector3d& p_WC,
                                               RimHalf half = RimHalf::seen) const;
  /// The half of a rim, near or far, that a camera at p_WC sees; `seen` for other parts, which have none.
  [[nodiscard]] RimHalf half_seen(EtalonPart part, const Eigen::Vector3d& p_WC) const;
  /// The point of that line (of a rim: of its tangent) nearest to the ray of sight through the pixel. None
  /// likewise, or where the lens sees nothing there.
  [[nodiscard]] std::optional<Eigen::Vector3d> nearest(const EtalonPoint& seen, const View& view) const;

  /// What a picture is expected to show, sigma left 0: two points of each side and of each red line that the
  /// camera faces within 60 degrees, one of each rim. None where it does not show all of the cylinder,
  /// `margin` px from its border at least.
  [[nodiscard]] std::optional<std::vector<EtalonPoint>> expected(const View& view, double margin) const;
  /// Of each rim, in an outline.
  static constexpr std::size_t rim_points = 32;
  /// Points of its two rims, px, as many of each, evenly around from where the camera stands: nothing of it
  /// is seen beyond what bounds these by more than half a hundredth of a rim's width. None likewise.
  [[nodiscard]] std::optional<std::array<Eigen::Vector2d, 2 * rim_points>> outline(const View& view,
                                                                                   double margin) const;
  /// The angle by which a red line lies to the right of where the camera stands around the cylinder, rad.
  [[nodiscard]] double bearing(std::size_t number, const Eigen::Vector3d& p_WC) const;

  /// Halfway up its axis, in W, m.
  [[nodiscard]] Eigen::Vector3d middle() const;
  /// Along its axis, in W, unit.
  [[nodiscard]] Eigen::Vector3d up() const { return X_WE_.rotation.col(1); }

 private:
  Pose X_WE_;
  double radius_, height_, red_radius_;
};

}  // namespace flexura
