#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Pixels of material points of an arm in cameras, and their derivatives with respect to the arm's state
/// (docs/control.md, eq. 16). The results equal the results of BackboneJacobian up to rounding. This class
/// computes only positions, not rotations, and is fast for many points in a few cameras. Allocates memory
/// only at the first use.
class PointImages {
 public:
  /// `shares`: positions of the points, as shares of the unstretched arm's length from its base. Throws
  /// std::invalid_argument if a share is outside [0, 1].
  PointImages(Arm arm, const std::vector<double>& shares);

  /// Returns the number of points: one per share, in their order.
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(points_.size()); }
  /// Returns the number of columns of derivatives: bend_x, bend_y (rad) and stretch of each section.
  [[nodiscard]] Eigen::Index columns() const { return 3 * static_cast<Eigen::Index>(arm_.sections.size()); }

  /// Sets the arm's state. Throws std::invalid_argument if the state does not fit the arm.
  void set(const ArmState& state);
  /// Returns p_WP of point i, m.
  [[nodiscard]] Eigen::Vector3d place(Eigen::Index i) const;

  /// Computes the points' pixels. Returns false if a point is outside the lens's valid field. Requires set().
  [[nodiscard]] bool see(const View& view, Eigen::Matrix2Xd& pixels) const;
  // NOLINTNEXTLINE(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Computes the pixels and their derivatives, a matrix of 2 count() x columns() with two rows per point.
  [[nodiscard]] bool see(const View& view, Eigen::Matrix2Xd& pixels, Eigen::Ref<Eigen::MatrixXd> by_state);

 private:
  struct Point {
    std::size_t section = 0;
    double fraction = 0;  // Position as a share of the section's length.
    // For an arc of unit length bent by (b_x, b_y), t = |b|: the point at the fraction f is at across * b
    // sideways and `along` forwards, with across = (1 - cos ft)/t^2 and along = sin ft/t. The slopes are
    // their derivatives with respect to t, divided by t.
    double across = 0, along = 0, across_slope = 0, along_slope = 0;
  };
  // A section in a camera, in C.
  struct SeenSection {
    Eigen::Vector3d origin = {0, 0, 0}, x = {0, 0, 0}, y = {0, 0, 0}, z = {0, 0, 0};  // Its base and axes.
    // Motion of everything beyond the section per unit of bend_x and bend_y: rotation, and velocity at C's
    // origin.
    Eigen::Vector3d turn_x = {0, 0, 0}, turn_y = {0, 0, 0}, shift_x = {0, 0, 0}, shift_y = {0, 0, 0};
    Eigen::Vector3d stretch = {0, 0, 0};  // Motion per unit of stretch.
  };
  static void place_in(Point& point, double bend);
  [[nodiscard]] Eigen::Vector3d place_in(const SeenSection& seen, const Point& point) const;
  [[nodiscard]] static SeenSection seen_base(const View& view, const BackboneJacobian::Part& part);

  Arm arm_;
  std::vector<Point> points_;
  BackboneJacobian backbone_;
  std::vector<SeenSection> seen_;
};

}  // namespace flexura
