#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Points of the two curves along which one camera's rays touch an arm's side, two a cross-section: right of
/// the way from base to tip as the picture shows it, then left (docs/control.md, eq. 19a and 19b). All are
/// not numbers where rays touch the section nowhere: the arm points at the camera there.
struct ContourImage {
  Eigen::Matrix2Xd pixels;   ///< px, a column a point.
  Eigen::Matrix2Xd normals;  ///< Unit, across the curve in the picture, away from the arm.
  Eigen::Matrix3Xd places;   ///< p_CP, m.
  Eigen::Matrix3Xd arms;     ///< From the section's middle to P, in C, m.
  /// By how much the curve moves along `normals` as the surface at P moves, by p_CP, px/m.
  Eigen::Matrix3Xd slopes;
  /// And P's pixel along the curve, the normal turned from v to u.
  Eigen::Matrix3Xd slides;

  /// Whether the contour has point i.
  [[nodiscard]] bool has(Eigen::Index i) const { return pixels.col(i).allFinite(); }
};

/// The contours of an arm before cameras, and how they move across themselves. Reused, it allocates no more.
class ContourImages {
 public:
  /// Of the cross-sections at `shares` of the unstretched arm's length, from its base. std::invalid_argument:
  /// one outside [0, 1].
  ContourImages(Arm arm, const std::vector<double>& shares);

  /// Points of one image: two a share.
  [[nodiscard]] Eigen::Index count() const { return 2 * static_cast<Eigen::Index>(points_.size()); }
  /// Columns of derivatives: each section's bend_x, bend_y (rad), stretch.
  [[nodiscard]] Eigen::Index columns() const { return 3 * static_cast<Eigen::Index>(arm_.sections.size()); }

  /// The arm as it stands now. std::invalid_argument: a state that does not fit.
  void set(const ArmState& state);
  /// Its contours. False where the lens shows one of their points nowhere. set() comes before.
  [[nodiscard]] bool see(const View& view, ContourImage& image) const;
  // NOLINTNEXTLINE(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// By how much the curves that `view` showed move along their normals, by the state: count() x columns(),
  /// px/rad and px; rows of zeros where there is no contour.
  void derive(const View& view, const ContourImage& image, Eigen::Ref<Eigen::MatrixXd> by_state);
  // NOLINTBEGIN(performance-unnecessary-value-param): as above.
  /// The same along other `directions` (unit, a column a point) than the normals, of the surface under the
  /// curve; rows of zeros where these are not numbers.
  void derive(const View& view, const ContourImage& image,
              const Eigen::Ref<const Eigen::Matrix2Xd>& directions, Eigen::Ref<Eigen::MatrixXd> by_state);
  // NOLINTEND(performance-unnecessary-value-param)

 private:
  // A cross-section as it stands.
  struct Ring {
    Pose X_WS;
    double radius = 0;
    double widening = 0;          // By arc length.
    Eigen::Vector3d curvature_W;  // Towards the arc's middle, 1/m.
  };
  // Which of the two points of a ring, in C: 1 to the right, -1 to the left. False where there is none.
  [[nodiscard]] static bool touch(const Ring& ring, const View& view, double side, Eigen::Vector3d& arm,
                                  Eigen::Vector3d& normal);
  [[nodiscard]] static bool see(const Ring& ring, const View& view, Eigen::Index i, ContourImage& image);

  Arm arm_;
  std::vector<MaterialPoint> points_;
  std::vector<Ring> rings_;
  BackboneJacobian backbone_;
  Jacobian by_;
};

/// How far what is seen lies from what is desired, across the edges: pixels of at.pixels' order, whose
/// normals are those of the contours `at` and, where it shall be, `desired_normals`; along the direction
/// half-way between the two, which is the way of a piece of edge that turns as evenly as it goes. 0 where one
/// of the three has no edge. std::invalid_argument: other numbers of points.
// NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
void contour_error(const ContourImage& at, const Eigen::Ref<const Eigen::Matrix2Xd>& seen,
                   const Eigen::Ref<const Eigen::Matrix2Xd>& desired,
                   const Eigen::Ref<const Eigen::Matrix2Xd>& desired_normals,
                   Eigen::Ref<Eigen::VectorXd> error);
/// The directions half-way between two normals of each point; not numbers where one of them is none, or they
/// are each other's opposite.
void halfway_normals(const Eigen::Ref<const Eigen::Matrix2Xd>& one,
                     const Eigen::Ref<const Eigen::Matrix2Xd>& other, Eigen::Ref<Eigen::Matrix2Xd> middle);
// NOLINTEND(performance-unnecessary-value-param)

}  // namespace flexura
