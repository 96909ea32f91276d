#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Points of the two curves along which one camera's rays touch an arm's side, two per cross-section. The
/// first is right of the direction from base to tip in the picture, then the left one (docs/control.md, eq.
/// 19a and 19b). All values are NaN where rays do not touch the section: the arm points at the camera
/// there.
struct ContourImage {
  Eigen::Matrix2Xd pixels;   ///< px, a column per point.
  Eigen::Matrix2Xd normals;  ///< Unit, across the curve in the picture, away from the arm.
  Eigen::Matrix3Xd places;   ///< p_CP, m.
  Eigen::Matrix3Xd arms;     ///< From the section's middle to P, in C, m.
  /// Derivatives of the curve's motion along `normals` by p_CP of the surface at P, px/m.
  Eigen::Matrix3Xd slopes;
  /// Derivatives of the motion of P's pixel along the curve, in the direction of the normal turned from v to
  /// u, px/m.
  Eigen::Matrix3Xd slides;

  /// Returns true if the contour has point i.
  [[nodiscard]] bool has(Eigen::Index i) const { return pixels.col(i).allFinite(); }
};

/// Contours of an arm in cameras, and their motion across themselves. Allocates only at the first use.
class ContourImages {
 public:
  /// For the cross-sections at `shares` of the unstretched arm's length, from its base. Throws
  /// std::invalid_argument if one is outside [0, 1].
  ContourImages(Arm arm, const std::vector<double>& shares);

  /// Returns the number of points in one image: two per share.
  [[nodiscard]] Eigen::Index count() const { return 2 * static_cast<Eigen::Index>(points_.size()); }
  /// Returns the number of columns of derivatives: each section's bend_x, bend_y (rad), stretch.
  [[nodiscard]] Eigen::Index columns() const { return 3 * static_cast<Eigen::Index>(arm_.sections.size()); }

  /// Sets the arm's state. Throws std::invalid_argument if it does not fit.
  void set(const ArmState& state);
  /// Computes its contours. Returns false if the lens does not show one of their points. Requires set().
  [[nodiscard]] bool see(const View& view, ContourImage& image) const;
  // NOLINTNEXTLINE(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Computes the derivatives of the motion of the curves in `view` along their normals by the state: count()
  /// x columns(), px/rad and px. Rows without a contour are zero.
  void derive(const View& view, const ContourImage& image, Eigen::Ref<Eigen::MatrixXd> by_state);
  // NOLINTBEGIN(performance-unnecessary-value-param): as above.
  /// Computes the derivatives along other `directions` (unit, a column per point) than the normals, for the
  /// surface under the curve. Rows are zero where these are not numbers.
  void derive(const View& view, const ContourImage& image,
              const Eigen::Ref<const Eigen::Matrix2Xd>& directions, Eigen::Ref<Eigen::MatrixXd> by_state);
  // NOLINTEND(performance-unnecessary-value-param)

 private:
  // A cross-section in the current state.
  struct Ring {
    Pose X_WS;
    double radius = 0;
    double widening = 0;          // By arc length.
    Eigen::Vector3d curvature_W;  // Towards the arc's middle, 1/m.
  };
  // Computes one of the two points of a ring, in C: 1 for the right one, -1 for the left one. Returns false
  // if it does not exist.
  [[nodiscard]] static bool touch(const Ring& ring, const View& view, double side, Eigen::Vector3d& arm,
                                  Eigen::Vector3d& normal);
  [[nodiscard]] static bool see(const Ring& ring, const View& view, Eigen::Index i, ContourImage& image);

  Arm arm_;
  std::vector<MaterialPoint> points_;
  std::vector<Ring> rings_;
  BackboneJacobian backbone_;
  Jacobian by_;
};

/// Computes the distance of the measured from the desired edges, across the edges, px. The pixels are in the
/// order of at.pixels. The normals are those of the contours `at` and, for the desired ones,
/// `desired_normals`. The distance is along the direction half-way between the two normals, as a piece of
/// edge with uniform rotation moves. 0 where one of the three has no edge. Throws std::invalid_argument for
/// other numbers of points.
// NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
void contour_error(const ContourImage& at, const Eigen::Ref<const Eigen::Matrix2Xd>& seen,
                   const Eigen::Ref<const Eigen::Matrix2Xd>& desired,
                   const Eigen::Ref<const Eigen::Matrix2Xd>& desired_normals,
                   Eigen::Ref<Eigen::VectorXd> error);
/// Computes the directions half-way between two normals of each point. They are not numbers if one of the
/// normals is not, or they are opposite.
void halfway_normals(const Eigen::Ref<const Eigen::Matrix2Xd>& one,
                     const Eigen::Ref<const Eigen::Matrix2Xd>& other, Eigen::Ref<Eigen::Matrix2Xd> middle);
// NOLINTEND(performance-unnecessary-value-param)

}  // namespace flexura
