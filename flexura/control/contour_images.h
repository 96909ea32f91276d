#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Points of the two contours of an arm: the curves along which one camera's rays touch the arm's surface.
/// Each cross-section has two points (docs/control.md, eq. 19a and 19b). The first is right of the direction
/// from base to tip in the picture, the second left. Where the arm points at the camera, no rays touch the
/// cross-section, and all values are NaN.
struct ContourImage {
  Eigen::Matrix2Xd pixels;   ///< Pixels of the points, px, a column per point.
  Eigen::Matrix2Xd normals;  ///< Unit normals of the contours in the picture, away from the arm.
  Eigen::Matrix3Xd places;   ///< Positions p_CP of the points, m.
  Eigen::Matrix3Xd arms;     ///< Vectors from the cross-section's middle to the points P, in C, m.
  /// Derivatives of the contour's motion along `normals` with respect to p_CP of the surface point, px/m.
  Eigen::Matrix3Xd slopes;
  /// Derivatives of the motion of P's pixel along the contour with respect to p_CP, px/m. The positive
  /// direction is the normal, rotated by 90 degrees from +v to +u.
  Eigen::Matrix3Xd slides;

  /// Returns true if the contour has point i.
  [[nodiscard]] bool has(Eigen::Index i) const { return pixels.col(i).allFinite(); }
};

/// Contours of an arm in cameras, and their motion along their normals. Allocates only at the first use.
class ContourImages {
 public:
  /// `shares`: positions of the cross-sections, as shares of the unstretched arm's length from its base.
  /// Throws std::invalid_argument if a share is outside [0, 1].
  ContourImages(Arm arm, const std::vector<double>& shares);

  /// Returns the number of points in one image: two per share.
  [[nodiscard]] Eigen::Index count() const { return 2 * static_cast<Eigen::Index>(points_.size()); }
  /// Returns the number of columns of derivatives: bend_x, bend_y (rad) and stretch of each section.
  [[nodiscard]] Eigen::Index columns() const { return 3 * static_cast<Eigen::Index>(arm_.sections.size()); }

  /// Sets the arm's state. Throws std::invalid_argument if the state does not fit the arm.
  void set(const ArmState& state);
  /// Computes the contours of the arm in its state. Returns false if a point of the contours is outside the
  /// lens's valid field. Requires set().
  [[nodiscard]] bool see(const View& view, ContourImage& image) const;
  // NOLINTNEXTLINE(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Computes the derivatives of the contours' motion in `view` along their normals, with respect to the
  /// state. The matrix is count() x columns(), in px/rad and px. Rows without a contour point are zero.
  void derive(const View& view, const ContourImage& image, Eigen::Ref<Eigen::MatrixXd> by_state);
  // NOLINTBEGIN(performance-unnecessary-value-param): as above.
  /// Computes the derivatives for the motion along `directions` (unit vectors, a column per point) instead of
  /// the normals. Here a contour point moves with the surface point that is currently there. Rows are zero
  /// where a direction is not finite.
  void derive(const View& view, const ContourImage& image,
              const Eigen::Ref<const Eigen::Matrix2Xd>& directions, Eigen::Ref<Eigen::MatrixXd> by_state);
  // NOLINTEND(performance-unnecessary-value-param)

 private:
  // A cross-section in the current state.
  struct Ring {
    Pose X_WS;
    double radius = 0;
    double widening = 0;          // Derivative of the radius with respect to arc length.
    Eigen::Vector3d curvature_W;  // Towards the arc's middle, 1/m.
  };
  // Computes a contour point of a ring, in C. `side`: 1 for the right point, -1 for the left one. Returns
  // false if the point does not exist.
  [[nodiscard]] static bool touch(const Ring& ring, const View& view, double side, Eigen::Vector3d& arm,
                                  Eigen::Vector3d& normal);
  [[nodiscard]] static bool see(const Ring& ring, const View& view, Eigen::Index i, ContourImage& image);

  Arm arm_;
  std::vector<MaterialPoint> points_;
  std::vector<Ring> rings_;
  BackboneJacobian backbone_;
  Jacobian by_;
};

/// Computes the distances of the measured edges from the desired edges, perpendicular to the edges, px. All
/// points are in the order of at.pixels. The measured edges have the normals of the contours `at`; the
/// desired edges have `desired_normals`. Each distance is along the direction half-way between the two
/// normals, because a uniformly rotating piece of edge moves in this direction. The distance is 0 where the
/// measured edge, the desired edge or the contour does not exist. Throws std::invalid_argument if the numbers
/// of points differ.
// NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
void contour_error(const ContourImage& at, const Eigen::Ref<const Eigen::Matrix2Xd>& seen,
                   const Eigen::Ref<const Eigen::Matrix2Xd>& desired,
                   const Eigen::Ref<const Eigen::Matrix2Xd>& desired_normals,
                   Eigen::Ref<Eigen::VectorXd> error);
/// Computes, for each point, the direction half-way between two normals. The result is NaN if a normal is NaN
/// or if the two normals are opposite.
void halfway_normals(const Eigen::Ref<const Eigen::Matrix2Xd>& one,
                     const Eigen::Ref<const Eigen::Matrix2Xd>& other, Eigen::Ref<Eigen::Matrix2Xd> middle);
// NOLINTEND(performance-unnecessary-value-param)

}  // namespace flexura
