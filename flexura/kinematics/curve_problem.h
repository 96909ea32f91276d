#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/math/pose.h"

namespace flexura {

/// The residual of "the backbone shall lie along this curve", as a function of ArmVariables' x: for evenly
/// spaced parts f of the backbone's arc length, the distance (x, y, z in the base's axes) of its point there
/// from the polyline's point at the same part of its own length, over the arm's greatest length and over the
/// root of the number of points: |r|^2 is the mean square.
class CurveProblem final : public BoundedProblem {
 public:
  /// `points` in the base's frame, two or more with a length; `length` is the scale of distances, m.
  CurveProblem(const ArmVariables& variables, const std::vector<Eigen::Vector3d>& points, double length);

  [[nodiscard]] Eigen::Index row_count() const override {
    return 3 * static_cast<Eigen::Index>(wanted_.size());
  }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override;
  /// A curve is fitted as well as it can be: met only where nothing is left to gain.
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override { return r.squaredNorm() < 1e-26; }
  /// How far the backbone of state x is from the polyline, m: the largest distance of points at the same
  /// parts of either's length, at all of the polyline's own points and at many between them, where the
  /// residual looks at a few.
  [[nodiscard]] double largest_distance(const Eigen::VectorXd& x);

  /// The state that turns each section's end along the curve's tangent there.
  [[nodiscard]] Eigen::VectorXd start_along_tangents() const;
  /// The curve's last point, m.
  [[nodiscard]] const Eigen::Vector3d& end() const { return wanted_.back(); }

 private:
  /// A section as it stands.
  struct Placed {
    Pose X_BS;
    Eigen::Vector2d bend;
    double stretch = 1.0;
    double s = 0.0;       // Of its base, m.
    double length = 0.0;  // Stretched, m.
    Eigen::Vector3d end;
    Eigen::Matrix<double, 3, 2> linear, angular;  // Of its end, per bend.
  };
  void place(const Eigen::VectorXd& x);
  void point_rows(double fraction, std::size_t section, Eigen::Index row, const Eigen::Vector3d& wanted,
                  Eigen::VectorXd& r, Eigen::MatrixXd& J) const;
  [[nodiscard]] Eigen::Vector3d at(double fraction) const;
  [[nodiscard]] Eigen::Vector3d tangent_at(double fraction) const;

  const ArmVariables& variables_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> parts_;  // Of the polyline's length, at each point.
  std::vector<Eigen::Vector3d> wanted_;
  std::vector<Placed> placed_;
  double scale_;
};

}  // namespace flexura
