#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Where cameras see points of an arm's material, and how that changes with the arm's state (docs/control.md,
/// eq. 16): BackboneJacobian's numbers to rounding, of places alone, for many points before a few cameras.
/// Once it has seen an arm it allocates no more.
class PointImages {
 public:
  /// At `shares` of the unstretched arm's length, from its base. std::invalid_argument: one outside [0, 1].
  PointImages(Arm arm, const std::vector<double>& shares);

  /// Points: one a share, in their order.
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(points_.size()); }
  /// Columns of derivatives: each section's bend_x, bend_y (rad), stretch.
  [[nodiscard]] Eigen::Index columns() const { return 3 * static_cast<Eigen::Index>(arm_.sections.size()); }

  /// The arm as it stands now. std::invalid_argument: a state that does not fit.
  void set(const ArmState& state);
  /// p_WP of point i, m.
  [[nodiscard]] Eigen::Vector3d place(Eigen::Index i) const;

  /// The points' pixels. False where the lens shows one of them nowhere. set() comes before.
  [[nodiscard]] bool see(const View& view, Eigen::Matrix2Xd& pixels) const;
  // NOLINTNEXTLINE(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// And their derivatives, two rows a point, into 2 count() x columns().
  [[nodiscard]] bool see(const View& view, Eigen::Matrix2Xd& pixels, Eigen::Ref<Eigen::MatrixXd> by_state);

 private:
  struct Point {
    std::size_t section = 0;
    double fraction = 0;  // Of the section.
    // Of an arc of unit length bent by (b_x, b_y), t = |b|: the place at the fraction f is across * b aside
    // and `along` on, with across = (1 - cos ft)/t^2 and along = sin ft/t; and their derivatives by t, over
    // t.
    double across = 0, along = 0, across_slope = 0, along_slope = 0;
  };
  // A section as a camera sees it, in C.
  struct SeenSection {
    Eigen::Vector3d origin = {0, 0, 0}, x = {0, 0, 0}, y = {0, 0, 0}, z = {0, 0, 0};  // Its base and axes.
    // What lies beyond it turns with its end, by bend_x and bend_y; how fast it would move at C's origin.
    Eigen::Vector3d turn_x = {0, 0, 0}, turn_y = {0, 0, 0}, shift_x = {0, 0, 0}, shift_y = {0, 0, 0};
    Eigen::Vector3d stretch = {0, 0, 0};  // And how it moves by the stretch.
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
