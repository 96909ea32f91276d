#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Residual of "the backbone follows this curve", as a function of ArmVariables' x. It compares points at
/// evenly spaced shares f of the backbone's arc length with the polyline's points at the same shares of its
/// length. Each difference (x, y, z in base axes) is divided by the arm's greatest length and by the root of
/// the number of points. So |r|^2 is the mean square.
class CurveProblem final : public BoundedProblem {
 public:
  /// `points` in the base's frame, two or more with a length; `length` is the scale of distances, m.
  CurveProblem(const ArmVariables& variables, const std::vector<Eigen::Vector3d>& points, double length);

  [[nodiscard]] Eigen::Index row_count() const override {
    return 3 * static_cast<Eigen::Index>(desired_.size());
  }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override;
  /// Returns true if nothing is left to gain: a curve is fitted as well as possible.
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override { return r.squaredNorm() < 1e-26; }
  /// Returns the distance of the backbone in state x from the polyline, m. This is the largest distance of
  /// points at equal shares of both lengths. It includes all points of the polyline and many between them,
  /// more than the residual.
  [[nodiscard]] double largest_distance(const Eigen::VectorXd& x);

  /// Returns the state that turns each section's end along the curve's tangent there.
  [[nodiscard]] Eigen::VectorXd start_along_tangents() const;
  /// Returns the curve's last point, m.
  [[nodiscard]] const Eigen::Vector3d& end() const { return desired_.back(); }

 private:
  /// A section in a state.
  struct Placed {
    Pose X_BS;
    Eigen::Vector2d bend;
    double stretch = 1.0;
    double s = 0.0;       // Arc length of its base, m.
    double length = 0.0;  // Stretched, m.
    Eigen::Vector3d end;
    Eigen::Matrix<double, 3, 2> linear, angular;  // Of its end, per bend.
  };
  void place(const Eigen::VectorXd& x);
  void point_rows(double fraction, std::size_t section, Eigen::Index row, const Eigen::Vector3d& desired,
                  Eigen::VectorXd& r, Eigen::MatrixXd& J) const;
  [[nodiscard]] Eigen::Vector3d at(double fraction) const;
  [[nodiscard]] Eigen::Vector3d tangent_at(double fraction) const;

  const ArmVariables& variables_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> parts_;  // Share of the polyline's length up to each point.
  std::vector<Eigen::Vector3d> desired_;
  std::vector<Placed> placed_;
  double scale_;
};

}  // namespace flexura
